#include "formats/dataset/panorama.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <numbers>

namespace tureen {

namespace {

/// Rows of the matrix: right, up and backward of the view.
glm::dmat3 looking(glm::dvec3 forward, glm::dvec3 up) {
  return glm::transpose(glm::dmat3(glm::cross(forward, up), up, -forward));
}

/// The place in the photograph, in pixels, of the direction through a place of the face's image.
glm::dvec2 place_of(glm::dvec2 at, int side, const PanoramaFace& face, glm::ivec2 size) {
  const glm::dvec3 view(2 * at.x / side - 1, 1 - 2 * at.y / side, -1);
  const glm::dvec3 front = glm::transpose(face.view_from_front) * view;
  const double azimuth = std::atan2(front.x, -front.z);
  const double elevation = std::atan2(front.y, std::hypot(front.x, front.z));
  return {(azimuth / (2 * std::numbers::pi) + 0.5) * size.x,
          (0.5 - elevation / std::numbers::pi) * size.y};
}

/// The four pixels around a place and their weights. Columns continue around the sphere.
template <class Add>
void around(glm::dvec2 place, glm::ivec2 size, const Add& add) {
  const double x = place.x - 0.5, y = place.y - 0.5;
  const int left = int(std::floor(x)), top = int(std::floor(y));
  for (int j = 0; j < 2; ++j)
    for (int i = 0; i < 2; ++i) {
      const double weight = (i ? x - left : 1 - (x - left)) * (j ? y - top : 1 - (y - top));
      add((left + i + size.x) % size.x, std::clamp(top + j, 0, size.y - 1), weight);
    }
}

/// Calls add(x, y, weight) for the pixels of the photograph behind a pixel of the face.
template <class Add>
void behind(int x, int y, int side, const PanoramaFace& face, glm::ivec2 size, const Add& add) {
  for (const double dy : {0.25, 0.75})
    for (const double dx : {0.25, 0.75})
      around(place_of({x + dx, y + dy}, side, face, size), size, add);
}

}  // namespace

const std::array<PanoramaFace, 6> panorama_faces{{{"front", looking({0, 0, -1}, {0, 1, 0})},
                                                  {"right", looking({1, 0, 0}, {0, 1, 0})},
                                                  {"back", looking({0, 0, 1}, {0, 1, 0})},
                                                  {"left", looking({-1, 0, 0}, {0, 1, 0})},
                                                  {"up", looking({0, 1, 0}, {0, 0, 1})},
                                                  {"down", looking({0, -1, 0}, {0, 0, -1})}}};

Camera face_camera(int side) {
  Camera camera;
  camera.width = camera.height = side;
  camera.fx = camera.fy = camera.cx = camera.cy = 0.5 * side;
  return camera;
}

Image8 face_image(const Image8& photograph, const PanoramaFace& face) {
  const glm::ivec2 size(photograph.width, photograph.height);
  const int side = face_side(size.x);
  Image8 image(side, side);
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      glm::dvec4 sum(0.0);  // colour times alpha, and alpha
      behind(x, y, side, face, size, [&](int column, int row, double weight) {
        const glm::dvec4 pixel(photograph.at(column, row));
        sum += weight * pixel.a * glm::dvec4(glm::dvec3(pixel), 1.0);
      });
      if (sum.a <= 0) continue;
      const glm::dvec4 mean(glm::dvec3(sum) / sum.a, sum.a / 4);
      image.at(x, y) = glm::u8vec4(glm::clamp(mean, 0.0, 255.0) + 0.5);
    }
  return image;
}

std::vector<std::uint8_t> face_marks(const std::vector<std::uint8_t>& marked, glm::ivec2 size,
                                     const PanoramaFace& face) {
  const int side = face_side(size.x);
  std::vector<std::uint8_t> result;
  result.reserve(std::size_t(side) * std::size_t(side));
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      std::uint8_t any = 0;
      behind(x, y, side, face, size, [&](int column, int row, double weight) {
        if (weight > 0) any |= marked[std::size_t(row) * std::size_t(size.x) + std::size_t(column)];
      });
      result.push_back(any);
    }
  return result;
}

}  // namespace tureen
