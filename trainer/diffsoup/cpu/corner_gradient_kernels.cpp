// The arithmetic of kernels/edge_gradient.hpp in vectors. A lane is an edge: a visible pixel p of
// the face and one of its neighbours q.
#include <algorithm>
#include <bit>

#include "trainer/common/kernels/edge_gradient.hpp"
#include "trainer/diffsoup/cpu/corner_gradient.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "trainer/diffsoup/cpu/corner_gradient_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace tureen::trainer::HWY_NAMESPACE {
namespace corners {

namespace hn = hwy::HWY_NAMESPACE;

// Most faces have about sixteen edges in a tile.
constexpr hn::CappedTag<float, 8> d;
constexpr hn::RebindToSigned<decltype(d)> di;
constexpr hn::RebindToUnsigned<decltype(d)> du;
using Floats = hn::Vec<decltype(d)>;
using Ints = hn::Vec<decltype(di)>;
using Mask = hn::Mask<decltype(d)>;
constexpr int lanes = int(hn::MaxLanes(d));

/// The pixels of a tile and one more on each side. An edge past the image has an adjoint of 0.
struct EdgeTile {
  static constexpr int columns = tile_side + 2, rows = tile_side + 2;
  alignas(64) std::uint32_t face[rows * columns];
  alignas(64) float inverse_depth[rows * columns];
  // Sum over the channels of (g_p + g_q) (C_p - C_q) / 2, from p to the next pixel q.
  alignas(64) float right[rows * columns];
  alignas(64) float down[rows * columns];
  kernels::Rectangle within;

  EdgeTile(const BatchImage& image, std::size_t tile) : within(image.tile(tile)) {
    const int width = image.view.width, height = image.view.height;
    const int x0 = std::max(within.x0 - 1, 0), x1 = std::min(within.x1 + 1, width);
    const int y0 = std::max(within.y0 - 1, 0), y1 = std::min(within.y1 + 1, height);
    std::fill_n(right, rows * columns, 0.0f);
    std::fill_n(down, rows * columns, 0.0f);
    std::fill_n(face, rows * columns, no_face);
    std::fill_n(inverse_depth, rows * columns, 0.0f);
    for (int y = y0; y < y1; ++y) {
      const std::size_t first = std::size_t(y) * std::size_t(width) + std::size_t(x0);
      const int at = index(x0, y);
      for (int x = 0; x < x1 - x0; ++x) {
        face[at + x] = image.visible[first + std::size_t(x)].face;
        inverse_depth[at + x] = image.visible[first + std::size_t(x)].inverse_depth;
      }
      adjoints(image, first, 1, x1 - x0 - 1, right + at);
      if (y + 1 < y1) adjoints(image, first, std::size_t(width), x1 - x0, down + at);
    }
  }

  HWY_INLINE int index(int x, int y) const {
    return (y - within.y0 + 1) * columns + x - within.x0 + 1;
  }

 private:
  static HWY_INLINE void adjoints(const BatchImage& image, std::size_t first, std::size_t step,
                                  int count, float* HWY_RESTRICT out) {
    const std::size_t plane = image.pixels();
    const float* color = image.color.data() + first;
    const float* gradient = image.by_color.data() + first;
    const auto adjoint = [&](std::size_t p) {
      float sum = 0;
      for (std::size_t c = 0; c < 3; ++c, p += plane)
        sum += 0.5f * (gradient[p] + gradient[p + step]) * (color[p] - color[p + step]);
      return sum;
    };
    if (count < lanes) {
      for (int x = 0; x < count; ++x) out[x] = adjoint(std::size_t(x));
      return;
    }
    for (int x = 0; x < count; x += lanes) {
      const int from = std::min(x, count - lanes);  // the last vector overlaps the one before
      std::size_t p = std::size_t(from);
      Floats sum = hn::Zero(d);
      for (std::size_t c = 0; c < 3; ++c, p += plane) {
        const Floats g = hn::Add(hn::LoadU(d, gradient + p), hn::LoadU(d, gradient + p + step));
        const Floats change = hn::Sub(hn::LoadU(d, color + p), hn::LoadU(d, color + p + step));
        sum = hn::MulAdd(hn::Mul(hn::Set(d, 0.5f), g), change, sum);
      }
      hn::StoreU(sum, d, out + from);
    }
  }
};

/// The edges of one face, until they are added.
class EdgeList {
 public:
  explicit EdgeList(const EdgeTile& tile) : tile_(tile) {}

  /// Appends the edges of a pixel of the face with an adjoint. If both pixels of an edge show the
  /// face, each adds the same; then the left or upper one adds both.
  HWY_INLINE void append(int x, int y, std::uint32_t face) {
    const int at = tile_.index(x, y);
    append(at, x, y, -1, 0, tile_.right[at - 1], tile_.face[at - 1] != face);
    append(at, x, y, 1, 0, tile_.right[at], true);
    append(at, x, y, 0, -1, tile_.down[at - EdgeTile::columns],
           tile_.face[at - EdgeTile::columns] != face);
    append(at, x, y, 0, 1, tile_.down[at], true);
  }
  HWY_INLINE bool full() const { return size + 4 > capacity; }
  HWY_INLINE void clear() { size = 0; }

  static constexpr int capacity = 256;
  int size = 0;
  // Some entries more: unused lanes of the last vector are also read.
  alignas(64) std::int32_t at[capacity + lanes] = {};  // p in the tile
  alignas(64) std::int32_t x[capacity + lanes] = {};   // of p in the image
  alignas(64) std::int32_t y[capacity + lanes] = {};
  alignas(64) std::int32_t dx[capacity + lanes] = {};  // from p to q
  alignas(64) std::int32_t dy[capacity + lanes] = {};
  alignas(64) float adjoint[capacity + lanes] = {};  // by the boundary's motion right or down

 private:
  HWY_INLINE void append(int p, int px, int py, int qx, int qy, float value, bool counts) {
    at[size] = p;
    x[size] = px;
    y[size] = py;
    dx[size] = qx;
    dy[size] = qy;
    adjoint[size] = value;
    // Neither 0 nor NaN: a colour that is not a number must not move the faces of its neighbours.
    size += int(counts) & (int(value < 0) | int(value > 0));
  }

  const EdgeTile& tile_;
};

/// The sum of the gradient over a face's edges in a tile.
class EdgeSum {
 public:
  HWY_INLINE EdgeSum(const BatchImage& image, const EdgeTile& tile, std::uint32_t index,
                     float slide)
      : image_(image), tile_(tile), face_(image.projected[index]), index_(index), slide_(slide) {
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) sums_[i][j] = hn::Zero(d);
  }

  HWY_NOINLINE void add(const EdgeList& list) {
    const Floats zero = hn::Zero(d), one = hn::Set(d, 1.0f);
    for (int first = 0; first < list.size; first += lanes) {
      Mask active = hn::FirstN(d, std::size_t(list.size - first));
      const Ints at = hn::Load(di, list.at + first);
      const Ints dx = hn::Load(di, list.dx + first), dy = hn::Load(di, list.dy + first);
      const Ints q_at = hn::Add(hn::Add(at, dx), hn::Mul(dy, hn::Set(di, EdgeTile::columns)));
      const auto q_face = hn::GatherIndex(du, tile_.face, q_at);
      const Floats p_inverse = hn::GatherIndex(d, tile_.inverse_depth, at);
      const Floats q_inverse = hn::GatherIndex(d, tile_.inverse_depth, q_at);
      const Mask same = hn::RebindMask(d, hn::Eq(q_face, hn::Set(du, index_)));
      const Mask background = hn::RebindMask(d, hn::Eq(q_face, hn::Set(du, no_face)));

      const Floats x = floats(list.x + first), y = floats(list.y + first);
      const Floats step_x = hn::ConvertTo(d, dx), step_y = hn::ConvertTo(d, dy);
      const Floats column = hn::Sub(x, hn::Set(d, float(face_.x0)));
      const Floats row = hn::Sub(y, hn::Set(d, float(face_.y0)));
      const Floats q_column = hn::Add(column, step_x), q_row = hn::Add(row, step_y);
      const Floats p[3] = {edge(0, column, row), edge(1, column, row), edge(2, column, row)};
      const Floats q[3] = {edge(0, q_column, q_row), edge(1, q_column, q_row),
                           edge(2, q_column, q_row)};
      const Floats inverse = hn::Add(hn::Add(q[0], q[1]), q[2]);
      const Mask inside = hn::Ge(hn::Min(hn::Min(q[0], q[1]), q[2]), zero);
      const Mask covers = hn::And(inside, hn::Gt(inverse, zero));
      const Mask shows_other = hn::AndNot(hn::Or(same, background), active);
      const Mask behind = hn::And(hn::And(covers, shows_other), hn::Gt(q_inverse, inverse));
      if (!hn::AllFalse(d, behind)) add_intersections(list, first, behind);
      // Left are the texture slide, the opacity, and the geometric case.
      const Mask in_front = hn::Or(background, hn::Gt(p_inverse, q_inverse));
      active = hn::And(active, hn::Or(same, hn::Or(covers, in_front)));
      active = hn::AndNot(behind, active);

      // The first edge of the triangle on the segment from p to q.
      Floats t = one;
      for (int k = 0; k < 3; ++k) {
        const Floats crossing = hn::Div(p[k], hn::Sub(p[k], q[k]));
        t = hn::IfThenElse(hn::And(hn::Lt(q[k], zero), hn::Lt(crossing, t)), crossing, t);
      }
      t = hn::IfThenElse(hn::Or(same, covers), hn::Set(d, 0.5f), t);

      // distribute() without the inverse depth at the boundary, which cancels out.
      Floats g = hn::Load(d, list.adjoint + first);
      g = hn::IfThenElseZero(active, hn::IfThenElse(same, hn::Mul(g, hn::Set(d, 2 * slide_)), g));
      const Mask vertical = hn::RebindMask(d, hn::Ne(dy, hn::Zero(di)));
      const Floats gx = hn::IfThenZeroElse(vertical, g), gy = hn::IfThenElseZero(vertical, g);
      const Floats at_x =
          hn::Add(hn::MulAdd(t, step_x, x), hn::Set(d, float(0.5 - image_.view.cx)));
      const Floats at_y =
          hn::Add(hn::MulAdd(t, step_y, y), hn::Set(d, float(0.5 - image_.view.cy)));
      // Other lanes may have an infinite t.
      const Floats gz =
          hn::IfThenElseZero(active, hn::Mul(g, hn::IfThenElse(vertical, at_y, at_x)));
      for (int i = 0; i < 3; ++i) {
        Floats e = hn::MulAdd(t, hn::Sub(q[i], p[i]), p[i]);
        e = hn::IfThenElseZero(hn::And(active, hn::Gt(e, zero)), e);
        sums_[i][0] = hn::MulAdd(e, gx, sums_[i][0]);
        sums_[i][1] = hn::MulAdd(e, gy, sums_[i][1]);
        sums_[i][2] = hn::NegMulAdd(e, gz, sums_[i][2]);
      }
    }
  }

  /// The gradient of the corners.
  HWY_INLINE void finish(float (&corners)[3][3]) const {
    const float scales[3] = {float(image_.view.fx), float(image_.view.fy), 1.0f};
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        corners[i][j] =
            intersections_[i][j] + scales[j] * hn::GetLane(hn::SumOfLanes(d, sums_[i][j]));
  }

 private:
  static HWY_INLINE Floats floats(const std::int32_t* values) {
    return hn::ConvertTo(d, hn::Load(di, values));
  }

  HWY_INLINE Floats edge(int k, Floats column, Floats row) const {
    return hn::MulAdd(hn::Set(d, face_.dy[k]), row,
                      hn::MulAdd(hn::Set(d, face_.dx[k]), column, hn::Set(d, face_.c[k])));
  }

  /// The edges whose q shows a face in front of this one.
  HWY_INLINE void add_intersections(const EdgeList& list, int first, Mask which) {
    std::uint8_t bits[8] = {};  // StoreMaskBits needs eight bytes
    hn::StoreMaskBits(d, which, bits);
    for (unsigned left = bits[0]; left; left &= left - 1) {
      const int i = first + std::countr_zero(left);
      add_intersection(list.at[i], list.x[i], list.y[i], list.dx[i], list.dy[i]);
    }
  }

  HWY_INLINE void add_intersection(int at, int x, int y, int dx, int dy) {
    const std::uint32_t shown = tile_.face[at + dy * EdgeTile::columns + dx];
    const kernels::ProjectedFace& other = image_.projected[shown];
    // Most of these faces do not intersect: the other one is not behind at p.
    float e[3];
    kernels::edge_values(other, float(x), float(y), e);
    const bool is_behind = e[0] + e[1] + e[2] < tile_.inverse_depth[at];
    if (!(is_behind & (e[0] >= 0) & (e[1] >= 0) & (e[2] >= 0))) return;
    const kernels::PointGradient point = kernels::edge_gradient(
        face_, &other, x, y, x + dx, y + dy, pixel(x, y), pixel(x + dx, y + dy), false, 0.0f);
    if (point.kind != kernels::EdgeCase::none)
      kernels::distribute(image_.view, face_, point, intersections_);
  }

  kernels::EdgePixel pixel(int x, int y) const {
    const std::size_t at = std::size_t(y) * std::size_t(image_.view.width) + std::size_t(x);
    kernels::EdgePixel result;
    result.face = image_.visible[at].face;
    result.inverse_depth = image_.visible[at].inverse_depth;
    for (std::size_t c = 0; c < 3; ++c) {
      result.color[c] = image_.color[c * image_.pixels() + at];
      result.gradient[c] = image_.by_color[c * image_.pixels() + at];
    }
    return result;
  }

  const BatchImage& image_;
  const EdgeTile& tile_;
  const kernels::ProjectedFace& face_;
  std::uint32_t index_;
  float slide_;
  Floats sums_[3][3];  // [corner][axis], without the focal length
  float intersections_[3][3] = {};
};

void find_corner_gradients_on(BatchImage& image, std::size_t tile, float slide) {
  const std::uint32_t tile_begin = image.bin_begin[tile], tile_end = image.bin_begin[tile + 1];
  if (tile_begin == tile_end) return;
  const EdgeTile pixels(image, tile);
  EdgeList list(pixels);
  std::uint32_t begin = 0;
  for (std::uint32_t i = tile_begin; i < tile_end; ++i) {
    const std::uint32_t end = image.fragments_end[i];
    if (begin == end) continue;  // its gradient is not read
    const std::uint32_t face = image.bins[i];
    EdgeSum sum(image, pixels, face, slide);
    float error = 0;
    for (const GradientFragment& fragment :
         image.fragments_of({std::uint32_t(tile), i, begin, end, 0})) {
      if (!fragment.visible) continue;
      error += image.loss[image.pixel_of(fragment)];
      list.append(int(fragment.x), int(fragment.y), face);
      if (!list.full()) continue;
      sum.add(list);
      list.clear();
    }
    if (list.size > 0) sum.add(list);
    list.clear();
    sum.finish(image.corner_gradient[i].corners);
    image.corner_gradient[i].error = error;
    begin = end;
  }
}

}  // namespace corners
using corners::find_corner_gradients_on;
}  // namespace tureen::trainer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tureen::trainer {

HWY_EXPORT(find_corner_gradients_on);

void find_corner_gradients(BatchImage& image, std::size_t tile, float slide) {
  HWY_DYNAMIC_DISPATCH(find_corner_gradients_on)(image, tile, slide);
}

}  // namespace tureen::trainer
#endif
