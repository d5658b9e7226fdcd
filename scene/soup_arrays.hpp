// The arrays of a soup with values per vertex and per face, listed once: counting, checking and
// keeping a part are loops over them.
#pragma once

#include "scene/spherical_harmonics.hpp"
#include "scene/triangle_soup.hpp"

namespace tureen {

/// Calls act(values, each, name) for every array of the soup that has `each` values a vertex;
/// `name` is a plural. Optional arrays that the soup lacks are left out.
template <class Soup, class Act>
void for_each_vertex_array(Soup& soup, const Act& act) {
  act(soup.positions, std::size_t(1), "positions");
  if (!soup.normals.empty()) act(soup.normals, std::size_t(1), "normals");
  if (auto* colors = std::get_if<VertexColors>(&soup.appearance))
    act(colors->rgba, std::size_t(1), "vertex colours");
  if (auto* sh = std::get_if<Harmonics>(&soup.appearance);
      sh && sh->domain == Harmonics::Domain::vertex)
    act(sh->coefficients, std::size_t(harmonics::count(sh->degree)), "harmonics coefficients");
  if (auto* textures = std::get_if<UvTextures>(&soup.appearance)) {
    act(textures->uv, std::size_t(1), "texture coordinates");
    if (!textures->vertex_rgba.empty())
      act(textures->vertex_rgba, std::size_t(1), "vertex colours");
  }
}

/// The same for every array that has `each` values a face.
template <class Soup, class Act>
void for_each_face_array(Soup& soup, const Act& act) {
  act(soup.triangles, std::size_t(1), "triangles");
  if (auto* colors = std::get_if<FaceColors>(&soup.appearance))
    act(colors->rgba, std::size_t(1), "face colours");
  if (auto* sh = std::get_if<Harmonics>(&soup.appearance);
      sh && sh->domain == Harmonics::Domain::face)
    act(sh->coefficients, std::size_t(harmonics::count(sh->degree)), "harmonics coefficients");
  if (auto* texture = std::get_if<LatticeTexture>(&soup.appearance))
    act(texture->patches, std::size_t(1), "lattice patches");
  if (auto* textures = std::get_if<UvTextures>(&soup.appearance))
    act(textures->material_of_face, std::size_t(1), "face materials");
}

}  // namespace tureen
