#include "formats/sog/palette_kernels.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "formats/sog/palette_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace tureen::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using PointTag = hn::CappedTag<float, PointBlocks::lanes / 2>;
using PointVector = hn::Vec<PointTag>;

/// The scores of two vectors of points, for each row.
struct ScorePair {
  PointVector low, high;
};

/// Calls act(row, part, scores), where the points of part p begin at 2 p vectors.
template <class Act>
HWY_INLINE void for_each_score(const PointBlocks& points, const PointRows& rows, Act&& act) {
  static_assert(rows_at_once == 4);
  const PointTag d;
  const std::size_t width = hn::Lanes(d), parts = PointBlocks::lanes / (2 * width);
  for (std::size_t b = 0; b * PointBlocks::lanes < points.offsets.size(); ++b)
    for (std::size_t p = 0; p < parts; ++p) {
      const std::size_t begin = 2 * p * width;
      const float* offsets = &points.offsets[b * PointBlocks::lanes + begin];
      const float* values = &points.values[b * PointBlocks::lanes * points.dimensions + begin];
      const PointVector low = hn::LoadU(d, offsets), high = hn::LoadU(d, offsets + width);
      ScorePair a{low, high}, e{low, high}, i{low, high}, o{low, high};
      for (std::size_t k = 0; k < points.dimensions; ++k, values += PointBlocks::lanes) {
        const PointVector first = hn::LoadU(d, values), second = hn::LoadU(d, values + width);
        const auto subtract = [&](const float* row, ScorePair& sum) HWY_ATTR {
          const PointVector value = hn::Set(d, row[k]);
          sum.low = hn::NegMulAdd(value, first, sum.low);
          sum.high = hn::NegMulAdd(value, second, sum.high);
        };
        subtract(rows[0], a);
        subtract(rows[1], e);
        subtract(rows[2], i);
        subtract(rows[3], o);
      }
      const std::size_t part = b * parts + p;
      act(0, part, a);
      act(1, part, e);
      act(2, part, i);
      act(3, part, o);
    }
}

void improve_on(const PointBlocks& points, const PointRows& rows, std::uint32_t first,
                std::array<PointBlocks::Nearest, rows_at_once>& best) {
  const PointTag d;
  const std::size_t width = hn::Lanes(d);
  struct Least {
    ScorePair score, part;
  };
  const PointVector most = hn::Set(d, std::numeric_limits<float>::max()), none = hn::Zero(d);
  Least least[rows_at_once] = {{{most, most}, {none, none}},
                               {{most, most}, {none, none}},
                               {{most, most}, {none, none}},
                               {{most, most}, {none, none}}};
  for_each_score(
      points, rows, [&](std::size_t row, std::size_t part, const ScorePair& scores) HWY_ATTR {
        const PointVector number = hn::Set(d, float(part));  // exact: below 2^24
        Least& all = least[row];
        const auto low = hn::Lt(scores.low, all.score.low);
        const auto high = hn::Lt(scores.high, all.score.high);
        all.score = {hn::Min(scores.low, all.score.low), hn::Min(scores.high, all.score.high)};
        all.part = {hn::IfThenElse(low, number, all.part.low),
                    hn::IfThenElse(high, number, all.part.high)};
      });
  float scores[PointBlocks::lanes], parts[PointBlocks::lanes];
  for (std::size_t r = 0; r < rows_at_once; ++r) {
    hn::StoreU(least[r].score.low, d, scores);
    hn::StoreU(least[r].score.high, d, scores + width);
    hn::StoreU(least[r].part.low, d, parts);
    hn::StoreU(least[r].part.high, d, parts + width);
    for (std::size_t l = 0; l < 2 * width; ++l)
      if (scores[l] < best[r].score)
        best[r] = {scores[l], first + std::uint32_t(std::size_t(parts[l]) * 2 * width + l)};
  }
}

void scores_on(const PointBlocks& points, const PointRows& rows,
               const std::array<float*, rows_at_once>& out) {
  const PointTag d;
  const std::size_t width = hn::Lanes(d);
  for_each_score(points, rows,
                 [&](std::size_t row, std::size_t part, const ScorePair& scores) HWY_ATTR {
                   hn::StoreU(scores.low, d, out[row] + 2 * part * width);
                   hn::StoreU(scores.high, d, out[row] + (2 * part + 1) * width);
                 });
}

}  // namespace tureen::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tureen {

HWY_EXPORT(improve_on);
HWY_EXPORT(scores_on);

PointBlocks::PointBlocks(std::span<const float> rows, std::size_t dimensions)
    : dimensions(dimensions) {
  const std::size_t count = rows.size() / dimensions, blocks = (count + lanes - 1) / lanes;
  values.assign(blocks * dimensions * lanes, 0.0f);
  // A missing point is never the nearest.
  offsets.assign(blocks * lanes, std::numeric_limits<float>::max());
  for (std::size_t i = 0; i < count; ++i) {
    float squared = 0;
    for (std::size_t d = 0; d < dimensions; ++d) {
      const float value = rows[i * dimensions + d];
      values[(i / lanes * dimensions + d) * lanes + i % lanes] = value;
      squared += value * value;
    }
    offsets[i] = squared / 2;
  }
}

void PointBlocks::improve(const PointRows& rows, std::uint32_t first,
                          std::array<Nearest, rows_at_once>& best) const {
  HWY_DYNAMIC_DISPATCH(improve_on)(*this, rows, first, best);
}

void PointBlocks::scores(const PointRows& rows, const std::array<float*, rows_at_once>& out) const {
  HWY_DYNAMIC_DISPATCH(scores_on)(*this, rows, out);
}

}  // namespace tureen
#endif
