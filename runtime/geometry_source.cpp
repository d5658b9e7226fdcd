#include "runtime/geometry_source.hpp"

#include <glm/geometric.hpp>

#include "runtime/face_part.hpp"

namespace tureen {

namespace {

struct Corner {
  glm::vec3 position;
  glm::vec2 barycentrics;
};

/// A point of a face, rounded to floats, with the barycentrics of where rounding has put it.
Corner corner_of_part(const std::array<glm::dvec3, 3>& face, glm::dvec2 at) {
  const glm::dvec3 u = face[0] - face[2], v = face[1] - face[2];
  const glm::vec3 position(face[2] + at.x * u + at.y * v);
  const glm::dvec3 w = glm::dvec3(position) - face[2];
  const double uu = glm::dot(u, u), uv = glm::dot(u, v), vv = glm::dot(v, v);
  const double uw = glm::dot(u, w), vw = glm::dot(v, w);
  return {position, glm::dvec2(vv * uw - uv * vw, uu * vw - uv * uw) / (uu * vv - uv * uv)};
}

FaceCorners corners_of(const TriangleSoup& soup, std::uint32_t face) {
  const glm::uvec3& t = soup.triangles[face];
  return {soup.positions[t.x], soup.positions[t.y], soup.positions[t.z]};
}

/// The corners of a whole face are its vertices to the bit.
std::array<Corner, 3> corners_of(const FaceCorners& whole, const FacePart& part) {
  const std::array<glm::dvec3, 3> face = {whole[0], whole[1], whole[2]};
  std::array<Corner, 3> corners;
  for (std::size_t k = 0; k < 3; ++k)
    corners[k] = part[k] == whole_face[k] ? Corner{whole[k], glm::vec2(part[k])}
                                          : corner_of_part(face, part[k]);
  return corners;
}

}  // namespace

GeometrySource prepare_geometry(const TriangleSoup& soup, std::span<const std::uint32_t> faces,
                                std::span<const FacePart> parts) {
  const std::size_t first_part = faces.size() - parts.size();
  GeometrySource source;
  source.face_count = faces.size();
  source.fill = [&soup, faces, parts, first_part](std::size_t first, std::span<FaceCorners> out) {
    for (std::size_t i = 0; i < out.size(); ++i) {
      const std::size_t slot = first + i;
      out[i] = corners_of(soup, faces[slot]);
      if (slot < first_part) continue;
      const std::array<Corner, 3> corners = corners_of(out[i], parts[slot - first_part]);
      for (std::size_t k = 0; k < 3; ++k) out[i][k] = corners[k].position;
    }
  };
  source.part_barycentrics.reserve(3 * parts.size());
  for (std::size_t i = 0; i < parts.size(); ++i)
    for (const Corner& corner : corners_of(corners_of(soup, faces[first_part + i]), parts[i]))
      source.part_barycentrics.push_back(corner.barycentrics);
  return source;
}

}  // namespace tureen
