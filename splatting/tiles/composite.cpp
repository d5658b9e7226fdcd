#include "splatting/tiles/composite.hpp"

#include <algorithm>
#include <cassert>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "splatting/tiles/composite.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "splatting/vector_math-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace tureen::splatting::HWY_NAMESPACE {

struct Pixels {
  Floats red, green, blue, alpha;
};

HWY_INLINE hn::VFromD<hn::RebindToSigned<FloatTag>> byte_of(Floats value) {
  const Floats limited = hn::Min(hn::Max(value, hn::Zero(d)), constant(1.0f));
  return hn::NearestInt(hn::Mul(limited, constant(255.0f)));
}

HWY_INLINE void store(const Pixels& pixels, std::uint32_t* colors) {
  const hn::RebindToSigned<FloatTag> di;
  const auto red_green = hn::Or(byte_of(pixels.red), hn::ShiftLeft<8>(byte_of(pixels.green)));
  const auto blue_alpha = hn::Or(byte_of(pixels.blue), hn::ShiftLeft<8>(byte_of(pixels.alpha)));
  hn::StoreU(hn::Or(red_green, hn::ShiftLeft<16>(blue_alpha)), di,
             reinterpret_cast<std::int32_t*>(colors));
}

HWY_INLINE void composite_vector(const float* rgba, const glm::vec4& background,
                                 std::uint32_t* colors) {
  Pixels front, color;
  hn::LoadInterleaved4(d, rgba, front.red, front.green, front.blue, front.alpha);
  const Floats through = hn::Sub(constant(1.0f), front.alpha);
  const auto over = [&](Floats value, float behind) {
    return hn::MulAdd(through, constant(behind * background.a), value);
  };
  color = {over(front.red, background.r), over(front.green, background.g),
           over(front.blue, background.b), over(front.alpha, 1)};
  if (background.a < 1) {
    const Mask visible = hn::Gt(color.alpha, hn::Zero(d));
    const auto straight = [&](Floats sum, float behind) {
      const Floats divisor = hn::IfThenElse(visible, color.alpha, constant(1.0f));
      return hn::IfThenElse(visible, hn::Div(sum, divisor), constant(behind));
    };
    color = {straight(color.red, background.r), straight(color.green, background.g),
             straight(color.blue, background.b), color.alpha};
  }
  store(color, colors);
}

void composite_on(std::span<const float> rgba, const glm::vec4& background,
                  std::span<std::uint32_t> colors) {
  std::size_t i = 0;
  for (; i + lanes <= colors.size(); i += lanes)
    composite_vector(&rgba[4 * i], background, &colors[i]);
  if (i == colors.size()) return;
  float last[4 * lanes] = {};
  std::uint32_t last_colors[lanes];
  std::copy(rgba.begin() + std::ptrdiff_t(4 * i), rgba.end(), last);
  composite_vector(last, background, last_colors);
  std::copy_n(last_colors, colors.size() - i, colors.begin() + std::ptrdiff_t(i));
}

}  // namespace tureen::splatting::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tureen::splatting {

HWY_EXPORT(composite_on);

void composite(std::span<const float> rgba, const glm::vec4& background,
               std::span<std::uint32_t> colors) {
  assert(rgba.size() == 4 * colors.size());
  HWY_DYNAMIC_DISPATCH(composite_on)(rgba, background, colors);
}

}  // namespace tureen::splatting
#endif
