#include "scene/edit/keep_faces.hpp"

#include <algorithm>
#include <cassert>
#include <vector>

#include "scene/lattice.hpp"
#include "scene/spherical_harmonics.hpp"

namespace tureen {

namespace {

/// The kept elements, in their order, and their new indices.
struct Selection {
  std::vector<std::uint32_t> kept;
  std::vector<std::uint32_t> place;  // new index of each kept element, by old index

  explicit Selection(const std::vector<std::uint8_t>& stays) : place(stays.size(), 0) {
    for (std::size_t i = 0; i < stays.size(); ++i) {
      if (!stays[i]) continue;
      place[i] = std::uint32_t(kept.size());
      kept.push_back(std::uint32_t(i));
    }
  }

  /// The kept part of an array with `each` values an element.
  template <class T>
  std::vector<T> of(const std::vector<T>& values, std::size_t each = 1) const {
    std::vector<T> result;
    result.reserve(kept.size() * each);
    for (const std::size_t i : kept)
      result.insert(result.end(), values.begin() + std::ptrdiff_t(i * each),
                    values.begin() + std::ptrdiff_t((i + 1) * each));
    return result;
  }
};

struct Kept {
  const Selection& faces;
  const Selection& vertices;

  Appearance operator()(const FaceColors& a) const { return FaceColors{faces.of(a.rgba)}; }
  Appearance operator()(const VertexColors& a) const { return VertexColors{vertices.of(a.rgba)}; }
  Appearance operator()(const Harmonics& a) const {
    const Selection& elements = a.domain == Harmonics::Domain::face ? faces : vertices;
    return Harmonics{
        .domain = a.domain,
        .degree = a.degree,
        .view = a.view,
        .coefficients = elements.of(a.coefficients, std::size_t(harmonics::count(a.degree)))};
  }
  Appearance operator()(const LatticeTexture& a) const {
    std::vector<std::uint8_t> used(a.texel_count(), 0);
    for (const std::uint32_t t : faces.kept) {
      const LatticePatch& patch = a.patches[t];
      std::fill_n(used.begin() + patch.first_texel, lattice::texel_count(int(patch.level)), 1);
    }
    const Selection texels(used);
    LatticeTexture result;
    result.patches = faces.of(a.patches);
    for (LatticePatch& patch : result.patches) patch.first_texel = texels.place[patch.first_texel];
    std::visit(
        [&](const auto& values) { result.texels = texels.of(values, LatticeTexture::channels); },
        a.texels);
    result.mlp = a.mlp;
    return result;
  }
  Appearance operator()(const UvTextures& a) const {
    UvTextures result = a;
    result.uv = vertices.of(a.uv);
    result.material_of_face = faces.of(a.material_of_face);
    if (!a.vertex_rgba.empty()) result.vertex_rgba = vertices.of(a.vertex_rgba);
    return result;
  }
};

}  // namespace

TriangleSoup keep_faces(const TriangleSoup& soup, std::span<const std::uint8_t> keeps) {
  assert(keeps.size() == soup.triangles.size());
  const Selection faces(std::vector<std::uint8_t>(keeps.begin(), keeps.end()));
  std::vector<std::uint8_t> used(soup.positions.size(), 0);
  for (const std::uint32_t t : faces.kept)
    for (int k = 0; k < 3; ++k) used[soup.triangles[t][k]] = 1;
  const Selection vertices(used);

  TriangleSoup result;
  result.positions = vertices.of(soup.positions);
  result.triangles = faces.of(soup.triangles);
  for (glm::uvec3& triangle : result.triangles)
    for (int k = 0; k < 3; ++k) triangle[k] = vertices.place[triangle[k]];
  result.appearance = std::visit(Kept{faces, vertices}, soup.appearance);
  return result;
}

}  // namespace tureen
