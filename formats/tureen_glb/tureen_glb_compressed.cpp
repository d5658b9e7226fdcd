#include "formats/tureen_glb/tureen_glb_compressed.hpp"

#include "base/crc32.hpp"
#include "base/error.hpp"
#include "formats/tureen_glb/tureen_glb.hpp"
#include "formats/tureen_glb/tureen_glb_writing.hpp"
#include "scene/edit/baked_transform.hpp"

namespace tureen {

using namespace glb_writing;

CompressedSoup encode_compressed(const TriangleSoup& soup, const CompressOptions& options) {
  return {encode_compressed_geometry({soup.positions, soup.triangles}, options.position_bits),
          encode_compressed_texels(std::get<LatticeTexture>(soup.appearance), options.texels)};
}

TriangleSoup decode_compressed(const CompressedSoup& compressed, const TriangleSoup& encoded) {
  const std::size_t faces = encoded.triangles.size();
  CompressedGeometry geometry = decode_compressed_geometry(
      compressed.geometry, used_vertices(encoded.triangles), faces, "a compressed soup");
  LatticeTexture texture = decode_compressed_texels(compressed.texels, faces, "a compressed soup");
  texture.mlp = std::get<LatticeTexture>(encoded.appearance).mlp;
  return {std::move(geometry.positions), std::move(geometry.triangles), std::move(texture)};
}

std::vector<std::string> write_compressed_glb(const Scene& scene, const CompressedSoup& compressed,
                                              const std::filesystem::path& path) {
  const auto* soup = std::get_if<TriangleSoup>(&only_layer(scene).primitives);
  const auto* texture = soup ? std::get_if<LatticeTexture>(&soup->appearance) : nullptr;
  if (!texture) throw UsageError("a compressed file holds lattice textures only");
  require_sound(*soup);
  const Layer& layer = only_layer(scene);
  if (!is_translation(layer))
    throw UsageError("a compressed file holds no layer that is rotated, scaled or mirrored");
  std::vector<std::string> losses;
  BinaryPlan plan;
  json extension = info_json(scene, losses);
  extension["version"] = tureen_compressed_version;
  add_origin(extension, layer);
  if (!layer.name.empty()) losses.push_back("a compressed file holds no name of a layer");
  if (!layer.visible) losses.push_back("the hidden layer is visible in a compressed file");
  if (!soup->normals.empty()) losses.push_back("a compressed file holds no normals");
  MaterialList materials;
  if (layer.material) extension["material"] = materials.add(*layer.material);
  extension["vertex_count"] = used_vertices(soup->triangles);
  extension["face_count"] = soup->triangles.size();
  const auto put = [&](json& holder, const std::string& key, std::span<const std::byte> bytes) {
    holder[key] = plan.view(bytes);
    holder[key + "_crc32"] = crc32_of(bytes);
  };
  put(extension, "slim_geometry", compressed.geometry);
  extension["appearance"] = {{"type", "lattice_texture"}};
  json& appearance = extension["appearance"];
  if (texture->mlp) appearance["color_mlp"] = mlp_json(plan, *texture->mlp);
  put(appearance, "slim_texels", compressed.texels);
  json document = {{"asset", {{"version", "2.0"}, {"generator", "Tureen"}}},
                   {"extensionsUsed", json::array({tureen_extension})},
                   {"extensionsRequired", json::array({tureen_extension})},
                   {"scene", 0},
                   {"scenes", json::array({json::object()})},
                   {"extensions", {{tureen_extension, std::move(extension)}}}};
  materials.write(document);
  write_glb(std::move(document), plan, path);
  return losses;
}

}  // namespace tureen
