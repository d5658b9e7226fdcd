// The corners of the planned faces before there is a device, three a slot.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "runtime/plan.hpp"
#include "soup/triangle_soup.hpp"

namespace tureen {

using FaceCorners = std::array<glm::vec3, 3>;

struct GeometrySource {
  std::size_t face_count = 0;
  /// Writes the corners of the faces in slots from `first` on, out.size() of them; may be called
  /// for any of them, in any order.
  std::function<void(std::size_t first, std::span<FaceCorners> out)> fill;
  /// Three for each of the last faces, of which only a part is drawn: where its corners lie in the
  /// whole face.
  std::vector<glm::vec2> part_barycentrics;

  std::size_t part_count() const { return part_barycentrics.size() / 3; }
};

/// `parts` are what is drawn of the last parts.size() of the faces; those before are drawn whole.
/// The source reads the elements of all three, which must outlive it where they are.
GeometrySource prepare_geometry(const TriangleSoup& soup, std::span<const std::uint32_t> faces,
                                std::span<const FacePart> parts = {});

}  // namespace tureen
