// Small-triangle culling: finds the faces of a frame that cover a pixel centre. The others do not
// affect the image. In a large soup seen as a whole most faces lie between pixel centres. On a
// software renderer the test costs a tenth of the time that the rasteriser needs to reject a
// triangle.
//
// Conservative: a face is culled only if no rasteriser could find a centre in it. This assumes
// corners snapped to the grid of GL_SUBPIXEL_BITS and one sample per pixel.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "runtime/passes/geometry_source.hpp"
#include "runtime/passes/pass.hpp"

namespace tureen {

class CoveredFaces {
 public:
  /// Keeps a copy of the corners of the source's faces: 36 bytes each.
  explicit CoveredFaces(const GeometrySource& source);

  /// Sets the frame for the following calls. `subpixel_bits`: GL_SUBPIXEL_BITS. Returns false if
  /// floats are too imprecise to locate corners, for enormous images and very narrow lenses; then
  /// all faces must be drawn.
  [[nodiscard]] bool begin_frame(const FrameCamera& frame, int subpixel_bits);

  /// Appends 3 i, 3 i + 1 and 3 i + 2 to `vertices` for each possibly visible face i of the run.
  void append(std::int32_t first_vertex, std::int32_t vertex_count,
              std::vector<std::uint32_t>& vertices) const;

  /// Bytes of the copy.
  std::size_t bytes() const { return coordinates_[0].size() * sizeof(float) * 9; }

 private:
  /// The camera in floats, as geometry.vert uses it.
  struct View {
    std::array<float, 3> eye_high, eye_low;
    std::array<float, 3> right, up, forward;
    float fx, fy, cx, cy;  // rows counted from the bottom
    float near;
    float width, height;
    float margin;  // largest distance of a corner from its place in the rasteriser, in pixels
  };
  struct Block;

  std::array<std::vector<float>, 9> coordinates_;  // x, y, z of corner 0, 1, 2
  View view_{};
};

}  // namespace tureen
