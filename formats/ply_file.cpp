#include "formats/ply_file.hpp"

#include "formats/mesh/mesh_ply.hpp"
#include "formats/mesh/plain_mesh.hpp"
#include "formats/ply/ply_header.hpp"
#include "formats/splat/compressed_ply.hpp"
#include "formats/splat/splat_builder.hpp"
#include "formats/splat/splat_ply.hpp"

namespace tureen {

Scene read_ply(Input& input, const ReadOptions& options) {
  const PlyHeader header = read_ply_header(input);
  if (is_compressed_ply(header)) return read_compressed_ply(input, header, options);
  if (is_splat_ply(header)) return read_splat_ply(input, header, options);
  return read_mesh_ply(input, header, options);
}

Scene read_ply(const std::filesystem::path& path, const ReadOptions& options) {
  Input input = Input::open(path);
  return read_ply(input, options);
}

glm::vec3 assumed_up_of_ply(const Scene& scene) {
  return fits_splat_ply(scene) ? splat_up : assumed_up;
}

std::vector<std::string> write_ply(const Scene& scene, const std::filesystem::path& path) {
  return fits_splat_ply(scene) ? write_splat_ply(scene, path) : write_mesh_ply(scene, path);
}

}  // namespace tureen
