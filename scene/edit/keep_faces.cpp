#include "scene/edit/keep_faces.hpp"

#include <algorithm>
#include <cassert>
#include <vector>

#include "scene/lattice.hpp"
#include "scene/soup_arrays.hpp"

namespace tureen {

namespace {

/// The kept elements, in their order, and their new indices.
struct Selection {
  std::vector<std::uint32_t> kept;
  std::vector<std::uint32_t> place;  // new index of each kept element, by old index

  explicit Selection(std::span<const std::uint8_t> stays) : place(stays.size(), 0) {
    for (std::size_t i = 0; i < stays.size(); ++i) {
      if (!stays[i]) continue;
      place[i] = std::uint32_t(kept.size());
      kept.push_back(std::uint32_t(i));
    }
  }

  /// Keeps these elements of an array with `each` values an element.
  template <class T>
  void keep_in(std::vector<T>& values, std::size_t each) const {
    auto to = values.begin();
    for (const std::size_t i : kept) {
      const auto from = values.begin() + std::ptrdiff_t(i * each);
      to = std::copy(from, from + std::ptrdiff_t(each), to);
    }
    values.resize(kept.size() * each);
    values.shrink_to_fit();
  }
};

void keep_used_texels(LatticeTexture& texture) {
  std::vector<std::uint8_t> used(texture.texel_count(), 0);
  for (const LatticePatch& patch : texture.patches)
    std::fill_n(used.begin() + patch.first_texel, lattice::texel_count(int(patch.level)), 1);
  const Selection texels(used);
  for (LatticePatch& patch : texture.patches) patch.first_texel = texels.place[patch.first_texel];
  std::visit([&](auto& values) { texels.keep_in(values, LatticeTexture::channels); },
             texture.texels);
}

}  // namespace

TriangleSoup keep_faces(TriangleSoup soup, std::span<const std::uint8_t> keeps) {
  assert(keeps.size() == soup.triangles.size());
  const Selection faces(keeps);
  for_each_face_array(
      soup, [&](auto& values, std::size_t each, const char*) { faces.keep_in(values, each); });
  std::vector<std::uint8_t> used(soup.positions.size(), 0);
  for (const glm::uvec3& triangle : soup.triangles)
    for (int k = 0; k < 3; ++k) used[triangle[k]] = 1;
  const Selection vertices(used);
  for_each_vertex_array(
      soup, [&](auto& values, std::size_t each, const char*) { vertices.keep_in(values, each); });
  for (glm::uvec3& triangle : soup.triangles)
    for (int k = 0; k < 3; ++k) triangle[k] = vertices.place[triangle[k]];
  if (auto* texture = std::get_if<LatticeTexture>(&soup.appearance)) keep_used_texels(*texture);
  return soup;
}

}  // namespace tureen
