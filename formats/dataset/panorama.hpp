// Photographs of the whole sphere, as COLMAP's EQUIRECTANGULAR: six pinhole views of 90 degrees,
// the faces of a cube around the camera.
#pragma once

#include <array>
#include <cstdint>
#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <string_view>
#include <vector>

#include "image/image.hpp"
#include "scene/camera.hpp"

namespace tureen {

struct PanoramaFace {
  std::string_view name;
  /// From the axes of the camera that looks at the middle of the photograph to those of the view;
  /// both look along -z, with y up.
  glm::dmat3 view_from_front;
};
extern const std::array<PanoramaFace, 6> panorama_faces;

/// Pixels of a face's side with the detail of a photograph of this width.
inline int face_side(int photograph_width) {
  return photograph_width / 4 > 0 ? photograph_width / 4 : 1;
}

/// The view of a face, without a pose.
Camera face_camera(int side);

/// The image of a face, by the mean of 2 x 2 bilinear samples per pixel, weighted by alpha. The
/// photograph's columns span 360 degrees, its rows 180.
Image8 face_image(const Image8& photograph, const PanoramaFace& face);

/// Which pixels of face_image() depend on a marked pixel of the photograph.
std::vector<std::uint8_t> face_marks(const std::vector<std::uint8_t>& marked, glm::ivec2 size,
                                     const PanoramaFace& face);

}  // namespace tureen
