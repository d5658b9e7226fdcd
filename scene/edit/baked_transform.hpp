// The rotation, scale and mirror of a layer, applied to its vertices: for formats and programs that
// place a soup only by a translation.
#pragma once

#include "scene/scene.hpp"

namespace tureen {

/// Whether world_from_layer is a translation: origin_of() then places the vertices exactly.
bool is_translation(const Layer& layer);

/// Whether a colour depends on the direction of view.
bool depends_on_view(const Layer& layer);

/// Positions times the rotation, scale and mirror of world_from_layer, computed in double and
/// rounded to float. The layer's translation is not included.
std::vector<glm::vec3> baked_positions(const std::vector<glm::vec3>& positions, const Layer& layer);

/// Replaces the positions of a soup by baked_positions(), moves its normals, and moves splats
/// (moved_splats.hpp). Afterwards world_from_layer is a translation. The colours of soups are data
/// in layer coordinates and stay as they are. Therefore throws UsageError if they depend on the
/// view, unless the transform is a translation.
void bake_transform(Layer& layer);

}  // namespace tureen
