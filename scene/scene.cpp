#include "scene/scene.hpp"

namespace tureen {

std::vector<std::string> all_notes(const SceneInfo& info) {
  std::vector<std::string> notes = info.notes;
  for (std::string& sentence : described(info.remarks)) notes.push_back(std::move(sentence));
  return notes;
}

TriangleSoup& opaque_soup(Scene& scene) {
  if (auto* soft = std::get_if<SoftTriangles>(&scene.primitives)) {
    OpaqueResult result = to_opaque(std::move(*soft));
    for (Remark& remark : result.remarks) scene.info.remarks.push_back(std::move(remark));
    scene.primitives = std::move(result.soup);
  }
  return std::get<TriangleSoup>(scene.primitives);
}

}  // namespace tureen
