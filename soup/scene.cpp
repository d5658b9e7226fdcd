#include "soup/scene.hpp"

namespace tureen {

TriangleSoup& opaque_soup(Scene& scene) {
  if (auto* soft = std::get_if<SoftTriangles>(&scene.primitives)) {
    OpaqueResult result = to_opaque(std::move(*soft));
    for (std::string& note : result.notes) scene.info.notes.push_back(std::move(note));
    scene.primitives = std::move(result.soup);
    if (scene.preset && defect(*scene.preset, std::get<TriangleSoup>(scene.primitives))) {
      scene.preset.reset();
      scene.info.notes.push_back(
          "the preset chooses among soft triangles, some of which are not drawn: it is left out");
    }
  }
  return std::get<TriangleSoup>(scene.primitives);
}

}  // namespace tureen
