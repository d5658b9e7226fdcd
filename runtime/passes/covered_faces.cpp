#include "runtime/passes/covered_faces.hpp"

#include <algorithm>
#include <cmath>

namespace tureen {

namespace {

/// Faces tested together, in loops that compilers vectorise.
constexpr std::size_t block_size = 64;

/// Largest distance of a tested corner outside the image, in image sizes. Clipping replaces corners
/// further out, so their faces are culled only if they lie entirely beside the image.
constexpr float guard = 1.0f;

/// In pixels. From half a pixel on, no face would fit between pixel centres.
constexpr float largest_margin = 0.25f;

float smallest(float a, float b, float c) {
  const float ab = a < b ? a : b;
  return ab < c ? ab : c;
}

float largest(float a, float b, float c) {
  const float ab = a > b ? a : b;
  return ab > c ? ab : c;
}

/// NaN becomes `low`.
float clamped(float value, float low, float high) {
  const float above = value > low ? value : low;
  return above < high ? above : high;
}

/// floor(value), for values from -`offset` on. `offset` is whole.
float floor_from(float value, float offset) {
  return static_cast<float>(static_cast<int>(value + offset)) - offset;
}

/// The function of one edge, relative to the first pixel centre, plus a margin. It is negative only
/// for points outside.
struct Edge {
  float at_00, per_x, per_y, margin;

  Edge(float x0, float y0, float x1, float y1, float sign, float corner_margin) {
    const float x = x1 - x0, y = y1 - y0;
    at_00 = sign * (y * x0 - x * y0);
    per_x = -sign * y;
    per_y = sign * x;
    // Moving the corners by up to the margin moves each point of the triangle by at most as much.
    // 1e-5: rounding of products of a few pixels.
    margin = corner_margin * (std::abs(x) + std::abs(y)) + 1e-5f;
  }
  float inside(float x, float y) const { return at_00 + x * per_x + y * per_y + margin; }
};

}  // namespace

/// Some faces in window coordinates.
struct CoveredFaces::Block {
  float x[3][block_size], y[3][block_size];
  std::int32_t in_front[3][block_size];  // of the near plane

  void project(const View& view, int corner, const float* px, const float* py, const float* pz,
               std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
      const float dx = (px[i] - view.eye_high[0]) - view.eye_low[0];
      const float dy = (py[i] - view.eye_high[1]) - view.eye_low[1];
      const float dz = (pz[i] - view.eye_high[2]) - view.eye_low[2];
      const float right = view.right[0] * dx + view.right[1] * dy + view.right[2] * dz;
      const float up = view.up[0] * dx + view.up[1] * dy + view.up[2] * dz;
      const float depth = view.forward[0] * dx + view.forward[1] * dy + view.forward[2] * dz;
      const float scale = 1.0f / depth;
      x[corner][i] = view.cx + view.fx * right * scale;
      y[corner][i] = view.cy + view.fy * up * scale;
      // Five roundings of the sum of the depth's terms. Below this bound even the sign is
      // uncertain.
      const float rounding = 5 * 0x1p-24f * (std::abs(dx) + std::abs(dy) + std::abs(dz));
      in_front[corner][i] = depth > view.near + rounding ? 1 : 0;
    }
  }

  /// Writes 1 for each face that may be visible, otherwise 0.
  void judge(const View& view, std::size_t count, std::uint32_t* shows) const {
    const float m = view.margin;
    const float left = -guard * view.width, right = (1 + guard) * view.width;
    const float bottom = -guard * view.height, top = (1 + guard) * view.height;
    for (std::size_t i = 0; i < count; ++i) {
      const float x0 = clamped(x[0][i], left, right), y0 = clamped(y[0][i], bottom, top);
      const float x1 = clamped(x[1][i], left, right), y1 = clamped(y[1][i], bottom, top);
      const float x2 = clamped(x[2][i], left, right), y2 = clamped(y[2][i], bottom, top);
      const float x_low = smallest(x0, x1, x2) - m, x_high = largest(x0, x1, x2) + m;
      const float y_low = smallest(y0, y1, y2) - m, y_high = largest(y0, y1, y2) + m;
      const int in_front_of_near = in_front[0][i] & in_front[1][i] & in_front[2][i];
      const int beside =
          int(x_high < 0) | int(x_low > view.width) | int(y_high < 0) | int(y_low > view.height);
      // 1 if clamping moved no corner.
      const int whole = int(x0 == x[0][i]) & int(x1 == x[1][i]) & int(x2 == x[2][i]) &
                        int(y0 == y[0][i]) & int(y1 == y[1][i]) & int(y2 == y[2][i]);

      // Pixel centres lie at whole numbers plus 1/2: the first column and row of them in the box.
      const float first_x = floor_from(x_low - 0.5f, 1 - left) + 1.5f;
      const float first_y = floor_from(y_low - 0.5f, 1 - bottom) + 1.5f;
      const float columns = x_high - first_x, rows = y_high - first_y;  // number of them: floor + 1
      const int between = int(columns < 0) | int(rows < 0);

      // Tests up to 2 x 2 centres against the edges.
      const float sign = (x1 - x0) * (y2 - y0) - (y1 - y0) * (x2 - x0) < 0 ? -1.0f : 1.0f;
      const Edge a(x0 - first_x, y0 - first_y, x1 - first_x, y1 - first_y, sign, m);
      const Edge b(x1 - first_x, y1 - first_y, x2 - first_x, y2 - first_y, sign, m);
      const Edge c(x2 - first_x, y2 - first_y, x0 - first_x, y0 - first_y, sign, m);
      const auto inside = [&](float px, float py) {
        return smallest(a.inside(px, py), b.inside(px, py), c.inside(px, py));
      };
      const float best =
          std::max(std::max(inside(0, 0), inside(1, 0)), std::max(inside(0, 1), inside(1, 1)));
      const int missed = int(columns < 2) & int(rows < 2) & int(best < 0);
      const int dropped = in_front_of_near & (beside | (whole & (between | missed)));
      shows[i] = static_cast<std::uint32_t>(1 - dropped);
    }
  }
};

CoveredFaces::CoveredFaces(const GeometrySource& source) {
  for (std::vector<float>& each : coordinates_) each.resize(source.face_count);
  std::vector<FaceCorners> block;
  for (std::size_t first = 0; first < source.face_count; first += block.size()) {
    block.resize(std::min(block_size, source.face_count - first));
    source.fill(first, block);
    for (std::size_t i = 0; i < block.size(); ++i)
      for (std::size_t corner = 0; corner < 3; ++corner)
        for (std::size_t c = 0; c < 3; ++c)
          coordinates_[3 * corner + c][first + i] = block[i][corner][int(c)];
  }
}

bool CoveredFaces::begin_frame(const FrameCamera& frame, int subpixel_bits) {
  const Camera& camera = frame.camera;
  const glm::dmat3 axes = camera.world_from_view_rotation();
  const auto floats = [](glm::dvec3 v) {
    return std::array<float, 3>{float(v.x), float(v.y), float(v.z)};
  };
  const glm::dvec3 eye_high = glm::dvec3(glm::vec3(frame.eye));
  view_ = {.eye_high = floats(eye_high),
           .eye_low = floats(frame.eye - eye_high),
           .right = floats(axes[0]),
           .up = floats(axes[1]),
           .forward = floats(-axes[2]),
           .fx = float(camera.fx),
           .fy = float(camera.fy),
           .cx = float(camera.cx),
           .cy = float(camera.height - camera.cy),
           .near = float(frame.range.near * (1 + 1e-6)),
           .width = float(camera.width),
           .height = float(camera.height),
           .margin = 0};
  // Snapping moves a corner by at most one unit of the subpixel grid. About a dozen float
  // operations, here and on the device, each round by 2^-24 of at most the focal length plus the
  // guarded image.
  const double sizes = camera.fx + camera.fy + 4.0 * (camera.width + camera.height) +
                       std::abs(camera.cx) + std::abs(camera.cy);
  view_.margin = float(std::ldexp(1.0, -subpixel_bits) + 16 * 0x1p-24 * sizes);
  return view_.margin < largest_margin;
}

void CoveredFaces::append(std::int32_t first_vertex, std::int32_t vertex_count,
                          std::vector<std::uint32_t>& vertices) const {
  const auto first = std::size_t(first_vertex) / 3, count = std::size_t(vertex_count) / 3;
  for (std::size_t begin = first; begin < first + count; begin += block_size) {
    const std::size_t size = std::min(block_size, first + count - begin);
    Block block;
    for (int corner = 0; corner < 3; ++corner) {
      const auto* axis = &coordinates_[3 * std::size_t(corner)];
      block.project(view_, corner, &axis[0][begin], &axis[1][begin], &axis[2][begin], size);
    }
    std::uint32_t shows[block_size];
    block.judge(view_, size, shows);
    // Writes every face without a branch; the next face overwrites a culled one.
    std::size_t end = vertices.size();
    vertices.resize(end + 3 * size);
    for (std::size_t i = 0; i < size; ++i) {
      const auto vertex = static_cast<std::uint32_t>(3 * (begin + i));
      vertices[end] = vertex;
      vertices[end + 1] = vertex + 1;
      vertices[end + 2] = vertex + 2;
      end += 3 * shows[i];
    }
    vertices.resize(end);
  }
}

}  // namespace tureen
