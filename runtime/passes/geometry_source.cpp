#include "runtime/passes/geometry_source.hpp"

namespace tureen {

GeometrySource prepare_geometry(const TriangleSoup& soup, std::span<const std::uint32_t> faces) {
  GeometrySource source;
  source.face_count = faces.size();
  source.fill = [&soup, faces](std::size_t first, std::span<FaceCorners> out) {
    for (std::size_t i = 0; i < out.size(); ++i) {
      const glm::uvec3& t = soup.triangles[faces[first + i]];
      out[i] = {soup.positions[t.x], soup.positions[t.y], soup.positions[t.z]};
    }
  };
  return source;
}

}  // namespace tureen
