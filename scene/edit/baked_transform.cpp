#include "scene/edit/baked_transform.hpp"

#include <glm/mat3x3.hpp>

#include "base/error.hpp"
#include "scene/edit/moved_normals.hpp"
#include "scene/edit/moved_splats.hpp"

namespace tureen {

namespace {

bool uses_direction(const std::optional<ColorMlp>& mlp) {
  return mlp && mlp->encoding != DirectionEncoding::none;
}

struct UsesDirection {
  bool operator()(const FaceColors&) const { return false; }
  bool operator()(const VertexColors&) const { return false; }
  bool operator()(const Harmonics& sh) const { return sh.degree > 0; }
  bool operator()(const LatticeTexture& texture) const { return uses_direction(texture.mlp); }
  bool operator()(const UvTextures& textures) const { return uses_direction(textures.mlp); }
};

}  // namespace

bool is_translation(const Layer& layer) {
  return layer.world_from_layer == at_origin(origin_of(layer));
}

bool depends_on_view(const Layer& layer) {
  if (const auto* splats = std::get_if<Splats>(&layer.primitives)) return splats->color.degree > 0;
  return std::visit(UsesDirection{}, std::get<TriangleSoup>(layer.primitives).appearance);
}

std::vector<glm::vec3> baked_positions(const std::vector<glm::vec3>& positions,
                                       const Layer& layer) {
  const glm::dmat3 linear(layer.world_from_layer);
  std::vector<glm::vec3> baked;
  baked.reserve(positions.size());
  for (const glm::vec3& position : positions) baked.emplace_back(linear * glm::dvec3(position));
  return baked;
}

void bake_transform(Layer& layer) {
  if (is_translation(layer)) return;
  if (auto* splats = std::get_if<Splats>(&layer.primitives)) {
    move_splats(*splats, glm::dmat4(glm::dmat3(layer.world_from_layer)));
  } else {
    if (depends_on_view(layer))
      throw UsageError(
          "the layer is rotated, scaled or mirrored, and its colours depend on the view: they "
          "cannot be moved into world coordinates");
    auto& soup = std::get<TriangleSoup>(layer.primitives);
    soup.positions = baked_positions(soup.positions, layer);
    move_normals(soup.normals, glm::dmat3(layer.world_from_layer));
  }
  layer.world_from_layer = at_origin(origin_of(layer));
}

}  // namespace tureen
