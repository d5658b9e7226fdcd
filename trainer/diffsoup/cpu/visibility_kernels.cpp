#include "trainer/diffsoup/cpu/visibility_kernels.hpp"

#include <algorithm>
#include <bit>
#include <limits>

#include "scene/lattice.hpp"
#include "scene/triangle_soup.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "trainer/diffsoup/cpu/visibility_kernels.cpp"
#include <hwy/cache_control.h>
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace tureen::trainer::HWY_NAMESPACE {
namespace soups {

namespace hn = hwy::HWY_NAMESPACE;

// Pixels of a row. Most faces are narrower than eight pixels, so wider vectors would be idle.
constexpr hn::CappedTag<float, 8> d;
constexpr hn::RebindToSigned<decltype(d)> di;
constexpr hn::RebindToUnsigned<decltype(d)> du;
using Floats = hn::Vec<decltype(d)>;
using Ints = hn::Vec<decltype(di)>;
using Words = hn::Vec<decltype(du)>;
using Mask = hn::Mask<decltype(d)>;
constexpr int lanes = int(hn::MaxLanes(d));

/// The visible faces of a tile. A vector may begin at any pixel, so rows have a margin.
struct VisibleTile {
  static constexpr int columns = tile_side + lanes;
  static constexpr int cell_side = 8, cells_a_side = tile_side / cell_side;
  alignas(64) std::uint32_t face[tile_side * columns];
  alignas(64) float inverse_depth[tile_side * columns];
  alignas(64) float b0[tile_side * columns];
  alignas(64) float b1[tile_side * columns];
  /// For each square cell: an inverse depth that all its pixels reach, and whether a pixel changed
  /// since it was computed.
  float cell_depth[cells_a_side * cells_a_side] = {};
  bool changed[cells_a_side * cells_a_side];

  explicit VisibleTile(const kernels::Rectangle& within) {
    std::ranges::fill(changed, true);
    std::fill_n(face, tile_side * columns, no_face);
    // Pixels outside the image are never visible, and not the farthest.
    std::fill_n(inverse_depth, tile_side * columns, std::numeric_limits<float>::infinity());
    std::fill_n(b0, tile_side * columns, 0.0f);
    std::fill_n(b1, tile_side * columns, 0.0f);
    for (int y = 0; y < within.y1 - within.y0; ++y)
      std::fill_n(inverse_depth + y * columns, within.x1 - within.x0, 0.0f);
  }

  HWY_INLINE void update_cell(int cell) {
    const float* first =
        inverse_depth + cell / cells_a_side * cell_side * columns + cell % cells_a_side * cell_side;
    Floats least = hn::LoadU(d, first);
    for (int y = 0; y < cell_side; ++y)
      for (int x = 0; x < cell_side; x += lanes)
        least = hn::Min(least, hn::LoadU(d, first + y * columns + x));
    cell_depth[cell] = hn::GetLane(hn::MinOfLanes(d, least));
    changed[cell] = false;
  }

  /// An inverse depth that all pixels of the tile reach.
  HWY_INLINE float smallest_depth() {
    for (int cell = 0; cell < cells_a_side * cells_a_side; ++cell)
      if (changed[cell]) update_cell(cell);
    return *std::ranges::min_element(cell_depth);
  }

  /// Whether all pixels of the cells that a rectangle in the tile touches, with inclusive bounds,
  /// are nearer than this.
  HWY_INLINE bool hides(int x0, int y0, int x1, int y1, float nearest) {
    for (int y = y0 / cell_side; y <= y1 / cell_side; ++y)
      for (int x = x0 / cell_side; x <= x1 / cell_side; ++x) {
        const int cell = y * cells_a_side + x;
        if (changed[cell]) update_cell(cell);
        if (nearest >= cell_depth[cell]) return false;
      }
    return true;
  }

  /// Call after a change of pixels in row y, from x on.
  HWY_INLINE void set_changed(int x, int y) {
    bool* row = changed + y / cell_side * cells_a_side;
    row[x / cell_side] = true;
    row[std::min((x + lanes - 1) / cell_side, cells_a_side - 1)] = true;
  }

  void copy_to(BatchImage& image, const kernels::Rectangle& within) const {
    for (int y = within.y0; y < within.y1; ++y) {
      VisiblePixel* row = &image.visible[std::size_t(y) * std::size_t(image.view.width)];
      int at = (y - within.y0) * columns;
      for (int x = within.x0; x < within.x1; ++x, ++at)
        row[x] = {face[at], inverse_depth[at], b0[at], b1[at]};
    }
  }
};

HWY_INLINE Floats floats(Ints value) { return hn::ConvertTo(d, value); }

/// lattice::texel_index(x, diagonal - x) of y = diagonal - x.
HWY_INLINE Ints texel_index(Ints diagonal, Ints y) {
  const Ints product = hn::Mul(diagonal, hn::Add(diagonal, hn::Set(di, 1)));
  return hn::Add(hn::ShiftRight<1>(product), y);
}

/// The interpolated alphas, by lattice::footprint() and lattice::interpolated(). Any barycentrics
/// are safe, also NaN.
HWY_INLINE Floats alphas(const float* texture, int level, Floats b0, Floats b1) {
  const Ints n = hn::Set(di, lattice::resolution(level)), one = hn::Set(di, 1);
  Floats p = hn::Mul(b0, floats(n)), q = hn::Mul(b1, floats(n));
  const auto cell = [](Floats value, Ints upper) HWY_ATTR {
    const Floats positive = hn::IfThenElseZero(hn::Gt(value, hn::Zero(d)), value);
    return hn::ConvertTo(di, hn::Min(positive, floats(upper)));
  };
  const Ints x = cell(p, hn::Sub(n, one)), next_x = hn::Add(x, one);
  const Ints y = cell(q, hn::Sub(n, next_x)), next_y = hn::Add(y, one);
  p = hn::Sub(p, floats(x));
  q = hn::Sub(q, floats(y));
  const Floats unit = hn::Set(d, 1.0f);
  const Mask upper = hn::Gt(hn::Add(p, q), unit);
  const Ints diagonal = hn::Add(next_x, y);
  const Ints first = texel_index(diagonal, y);  // (x + 1, y); (x, y + 1) is the next
  const Ints corner_y = hn::Min(next_y, hn::Sub(n, next_x));
  const Ints third =
      hn::IfThenElse(hn::RebindMask(di, upper), texel_index(hn::Add(next_x, corner_y), corner_y),
                     hn::Sub(first, diagonal));  // (x, y)
  const Floats a = hn::GatherIndex(d, texture, first);
  const Floats b = hn::GatherIndex(d, texture + 1, first);
  const Floats c = hn::GatherIndex(d, texture, third);
  const Floats w0 = hn::IfThenElse(upper, hn::Sub(unit, q), p);
  const Floats w1 = hn::IfThenElse(upper, hn::Sub(unit, p), q);
  return hn::MulAdd(w1, hn::Sub(b, c), hn::MulAdd(w0, hn::Sub(a, c), c));
}

/// kernels::mixed().
HWY_INLINE Words mixed(Words x) {
  x = hn::Mul(hn::Xor(x, hn::ShiftRight<16>(x)), hn::Set(du, 0x85ebca6bu));
  x = hn::Mul(hn::Xor(x, hn::ShiftRight<13>(x)), hn::Set(du, 0xc2b2ae35u));
  return hn::Xor(x, hn::ShiftRight<16>(x));
}

/// kernels::uniform_draw() of consecutive pixels.
HWY_INLINE Floats uniform_draws(std::uint32_t key, std::uint32_t first_pixel, std::uint32_t face) {
  const Words pixel = hn::Iota(du, first_pixel);
  const Words by_pixel = mixed(hn::Xor(pixel, hn::Set(du, key)));
  const Words bits = mixed(hn::Add(by_pixel, hn::Set(du, face * 0x9e3779b9u)));
  const Ints counted = hn::Add(hn::BitCast(di, hn::ShiftRight<8>(bits)), hn::Set(di, 1));
  return hn::Mul(floats(counted), hn::Set(d, 0x1p-24f));
}

/// Appends to a tile's list. The list is longer than its content, so that one check serves a whole
/// vector; it keeps its length for the next step.
class FragmentList {
 public:
  explicit FragmentList(std::vector<GradientFragment>& list) : list_(list) {}

  /// The fragments of the mask in a row of pixels from (x, y) on.
  HWY_INLINE void append(Mask which, int x, int y, Floats b0, Floats b1, Floats inverse_depth) {
    if (list_.size() < size_ + lanes) list_.resize(2 * size_ + 64);
    alignas(64) float values[3][lanes];
    hn::Store(b0, d, values[0]);
    hn::Store(b1, d, values[1]);
    hn::Store(inverse_depth, d, values[2]);
    std::uint8_t bits[8] = {};  // StoreMaskBits needs eight bytes
    hn::StoreMaskBits(d, which, bits);
    for (unsigned left = bits[0]; left; left &= left - 1) {
      const auto l = unsigned(std::countr_zero(left));
      GradientFragment& fragment = list_[size_++];
      fragment = {.visible = 0,
                  .x = (unsigned(x) + l) & 0x7fff,
                  .y = unsigned(y) & 0xffff,
                  .b0 = values[0][l],
                  .b1 = values[1][l],
                  .depth_or_factor = values[2][l]};
    }
  }
  std::size_t size() const { return size_; }

 private:
  std::vector<GradientFragment>& list_;
  std::size_t size_ = 0;
};

TileVisibility draw_tile_on(BatchImage& image, std::size_t tile, const AlphaTest& test) {
  const kernels::Rectangle within = image.tile(tile);
  const kernels::View& view = image.view;
  const std::size_t texels = lattice::texel_count(test.level);
  const Floats nearest = hn::Set(d, float(1 / view.near)), zero = hn::Zero(d);
  const Floats farthest = hn::Set(d, float(1 / view.far));
  std::vector<GradientFragment> unused;
  FragmentList list(image.keeps_fragments ? image.fragments[tile] : unused);
  VisibleTile shown(within);
  float behind = 0;                              // all pixels of the tile reach this inverse depth
  constexpr std::uint32_t faces_an_update = 16;  // an update takes as long as a few faces
  // Faces have no order in memory, so the processor cannot foresee which is next. Four faces take
  // longer than a load from memory. More lines than eight would displace what is in use.
  constexpr std::uint32_t faces_ahead = 4;
  constexpr std::size_t floats_a_line = 16;
  const std::size_t prefetched = std::min<std::size_t>(texels, 8 * floats_a_line);
  TileVisibility result{.fragments = 0, .end = image.bin_begin[tile]};
  for (std::uint32_t& i = result.end; i < image.bin_begin[tile + 1]; ++i) {
    const std::uint32_t index = image.bins[i];
    if (const std::uint32_t ahead = i + faces_ahead; ahead < image.bin_begin[tile + 1]) {
      hwy::Prefetch(&image.projected[image.bins[ahead]]);
      for (std::size_t at = 0; at < prefetched; at += floats_a_line)
        hwy::Prefetch(test.alpha + image.bins[ahead] * texels + at);
    }
    const float face_nearest = image.nearest[index];
    if ((i - image.bin_begin[tile]) % faces_an_update == faces_an_update - 1)
      behind = shown.smallest_depth();
    if (face_nearest < behind) break;  // this face is hidden, and so are those behind it
    const kernels::ProjectedFace& face = image.projected[index];
    const float* texture = test.alpha + index * texels;
    const int x0 = std::max<int>(face.x0, within.x0), x1 = std::min<int>(face.x1, within.x1);
    const int y0 = std::max<int>(face.y0, within.y0), y1 = std::min<int>(face.y1, within.y1);
    const bool hidden = shown.hides(x0 - within.x0, y0 - within.y0, x1 - 1 - within.x0,
                                    y1 - 1 - within.y0, face_nearest);
    for (int y = hidden ? y1 : y0; y < y1; ++y) {
      const float dy = float(y - face.y0);
      Floats row[3];
      for (int k = 0; k < 3; ++k) row[k] = hn::Set(d, face.c[k] + face.dy[k] * dy);
      for (int x = x0; x < x1; x += lanes) {
        // The arithmetic of kernels::fragment_at().
        const Floats dx = hn::Iota(d, float(x - face.x0));
        const Floats e0 = hn::MulAdd(hn::Set(d, face.dx[0]), dx, row[0]);
        const Floats e1 = hn::MulAdd(hn::Set(d, face.dx[1]), dx, row[1]);
        const Floats e2 = hn::MulAdd(hn::Set(d, face.dx[2]), dx, row[2]);
        const Floats inverse = hn::Add(hn::Add(e0, e1), e2);
        const Floats least = hn::Min(hn::Min(e0, e1), e2);
        Mask covered = hn::And(hn::Ge(least, zero), hn::FirstN(d, std::size_t(x1 - x)));
        covered = hn::And(covered, hn::And(hn::Ge(inverse, farthest), hn::Le(inverse, nearest)));
        if (hn::AllFalse(d, covered)) continue;
        result.fragments += hn::CountTrue(d, covered);
        const int at = (y - within.y0) * VisibleTile::columns + x - within.x0;
        const Floats depth = hn::LoadU(d, shown.inverse_depth + at);
        const Mask lower_face =
            hn::RebindMask(d, hn::Gt(hn::LoadU(du, shown.face + at), hn::Set(du, index)));
        const Mask in_front =
            hn::Or(hn::Gt(inverse, depth), hn::And(hn::Eq(inverse, depth), lower_face));
        const Mask nearer = hn::And(covered, in_front);
        if (hn::AllFalse(d, nearer)) continue;
        const Floats b0 = hn::Div(e0, inverse), b1 = hn::Div(e1, inverse);
        const std::uint32_t pixel = std::uint32_t(y * view.width + x);
        const Floats needed = test.masking == Masking::threshold
                                  ? hn::Set(d, alpha_threshold)
                                  : uniform_draws(image.draw_key, pixel, index);
        const Mask accepted = hn::And(nearer, hn::Ge(alphas(texture, test.level, b0, b1), needed));
        if (image.keeps_fragments) list.append(nearer, x, y, b0, b1, inverse);
        if (hn::AllFalse(d, accepted)) continue;
        shown.set_changed(x - within.x0, y - within.y0);
        hn::BlendedStore(hn::Set(du, index), hn::RebindMask(du, accepted), du, shown.face + at);
        hn::BlendedStore(inverse, accepted, d, shown.inverse_depth + at);
        hn::BlendedStore(b0, accepted, d, shown.b0 + at);
        hn::BlendedStore(b1, accepted, d, shown.b1 + at);
      }
    }
    if (image.keeps_fragments) image.fragments_end[i] = std::uint32_t(list.size());
  }
  shown.copy_to(image, within);
  return result;
}

}  // namespace soups
using soups::draw_tile_on;
}  // namespace tureen::trainer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tureen::trainer {

HWY_EXPORT(draw_tile_on);

TileVisibility draw_tile(BatchImage& image, std::size_t tile, const AlphaTest& test) {
  return HWY_DYNAMIC_DISPATCH(draw_tile_on)(image, tile, test);
}

}  // namespace tureen::trainer
#endif
