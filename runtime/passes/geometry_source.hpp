// The corners of the planned faces before a device exists, three a slot.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <span>

#include "scene/triangle_soup.hpp"

namespace tureen {

using FaceCorners = std::array<glm::vec3, 3>;

struct GeometrySource {
  std::size_t face_count = 0;
  /// Writes the corners of out.size() faces in slots from `first` on. May be called for any slots
  /// in any order.
  std::function<void(std::size_t first, std::span<FaceCorners> out)> fill;
};

/// The source reads the elements of both arguments, which must outlive it without moving.
GeometrySource prepare_geometry(const TriangleSoup& soup, std::span<const std::uint32_t> faces);

}  // namespace tureen
