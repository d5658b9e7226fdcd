// Which faces of a frame have the centre of a pixel in them: the others leave no trace, however
// they are rasterised. In a large soup seen as a whole most faces lie between the pixels, and where
// the processor draws, finding them costs a tenth of what a triangle costs that is sent to the
// rasteriser and dropped there.
//
// Conservative: a face is dropped only when no rasteriser could find a centre in it that snaps
// corners to the grid of GL_SUBPIXEL_BITS, with one sample a pixel.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "runtime/passes/geometry_source.hpp"
#include "runtime/passes/pipeline.hpp"

namespace tureen {

class CoveredFaces {
 public:
  /// Keeps a copy of the corners of the source's faces: 36 bytes each.
  explicit CoveredFaces(const GeometrySource& source);

  /// What follows is about this frame. `subpixel_bits`: GL_SUBPIXEL_BITS. False where floats know
  /// too little of where corners come to lie, in enormous pictures and through the narrowest
  /// lenses: then all faces have to be drawn.
  [[nodiscard]] bool begin_frame(const FrameCamera& frame, int subpixel_bits);

  /// Appends 3 i, 3 i + 1 and 3 i + 2 to `vertices` for each face i of the run that may show.
  void append(std::int32_t first_vertex, std::int32_t vertex_count,
              std::vector<std::uint32_t>& vertices) const;

  /// Of the copy.
  std::size_t bytes() const { return coordinates_[0].size() * sizeof(float) * 9; }

 private:
  /// The camera in floats, as geometry.vert works with it.
  struct View {
    std::array<float, 3> eye_high, eye_low;
    std::array<float, 3> right, up, forward;
    float fx, fy, cx, cy;  // rows counted from the bottom
    float near;
    float width, height;
    float margin;  // pixels that a corner may lie from where the rasteriser has it
  };
  struct Block;

  std::array<std::vector<float>, 9> coordinates_;  // x, y, z of corner 0, 1, 2
  View view_{};
};

}  // namespace tureen
