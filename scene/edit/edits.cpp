#include "scene/edit/edits.hpp"

#include <algorithm>
#include <cassert>

#include "scene/edit/baked_color.hpp"
#include "scene/edit/keep_faces.hpp"
#include "scene/edit/lattice_bytes.hpp"
#include "scene/edit/lattice_levels.hpp"
#include "scene/edit/lattice_refine.hpp"

namespace tureen {

std::string describe(const Edits& edits) {
  std::string text;
  const auto add = [&](const std::string& words) { text += (text.empty() ? "" : ", ") + words; };
  if (!edits.keeps_face.empty()) {
    const auto gone = std::count(edits.keeps_face.begin(), edits.keeps_face.end(), 0);
    add(std::to_string(std::ptrdiff_t(edits.keeps_face.size()) - gone) + " of " +
        std::to_string(edits.keeps_face.size()) + " triangles");
  }
  if (edits.lattice_level < lattice::max_level)
    add("lattice level at most " + std::to_string(edits.lattice_level));
  if (edits.color == Edits::Color::baked) add("baked colour");
  if (edits.color == Edits::Color::base) add("base colour");
  if (edits.byte_texels) add("8 bits per texel channel");
  return text.empty() ? "none" : text;
}

std::vector<std::string> names_of(const Edits& edits) {
  const Edits unchanged;
  std::vector<std::string> names;
  if (edits.keeps_face != unchanged.keeps_face) names.emplace_back("keeps_face");
  if (edits.lattice_level != unchanged.lattice_level) names.emplace_back("lattice_level");
  if (edits.color != unchanged.color) names.emplace_back("color");
  if (edits.byte_texels != unchanged.byte_texels) names.emplace_back("byte_texels");
  return names;
}

std::optional<std::string> defect(const Edits& edits, const TriangleSoup& soup) {
  if (edits.lattice_level < 0 || edits.lattice_level > lattice::max_level)
    return "the lattice level is " + std::to_string(edits.lattice_level) + ", not 0 to 7";
  if (edits.keeps_face.empty()) return std::nullopt;
  if (edits.keeps_face.size() != soup.triangles.size())
    return "the selection has " + std::to_string(edits.keeps_face.size()) +
           " triangles, but the scene has " + std::to_string(soup.triangles.size());
  if (std::count(edits.keeps_face.begin(), edits.keeps_face.end(), 0) ==
      std::ptrdiff_t(edits.keeps_face.size()))
    return "no triangle is kept";
  return std::nullopt;
}

Edits effective(const Edits& edits, const TriangleSoup& soup) {
  Edits result;
  if (std::count(edits.keeps_face.begin(), edits.keeps_face.end(), 0) > 0)
    result.keeps_face = edits.keeps_face;
  const auto* texture = std::get_if<LatticeTexture>(&soup.appearance);
  if (!texture) return result;
  if (highest_level(*texture) > edits.lattice_level) result.lattice_level = edits.lattice_level;
  if (texture->mlp) result.color = edits.color;
  result.byte_texels = edits.byte_texels && texture->is_float();
  return result;
}

TriangleSoup edited(TriangleSoup soup, const Edits& edits,
                    const std::function<void(double)>& progress) {
  assert(!defect(edits, soup));
  if (!edits.keeps_face.empty()) soup = keep_faces(std::move(soup), edits.keeps_face);
  auto* texture = std::get_if<LatticeTexture>(&soup.appearance);
  if (!texture) return soup;
  if (highest_level(*texture) > edits.lattice_level)
    *texture = at_most_level(*texture, edits.lattice_level, progress);
  if (edits.color == Edits::Color::baked) *texture = baked_color(*texture, progress);
  if (edits.color == Edits::Color::base) *texture = base_color(std::move(*texture));
  if (edits.byte_texels) round_to_bytes(*texture);
  return soup;
}

}  // namespace tureen
