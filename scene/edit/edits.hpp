// Changes to a soup's data that make it cheaper to draw and to store. `tureen tradeoff` measures
// their error.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "scene/lattice.hpp"
#include "scene/triangle_soup.hpp"

namespace tureen {

/// The default changes nothing. Level, colour and bytes apply only to lattice textures.
struct Edits {
  /// One entry per face: 0 removes the face. An empty vector keeps all faces. At least one entry
  /// must keep its face.
  std::vector<std::uint8_t> keeps_face = {};
  /// Largest lattice level of any face, 0..lattice::max_level. Finer lattices are projected
  /// (scene/edit/lattice_levels.hpp).
  int lattice_level = lattice::max_level;
  /// The mapping from texels to colour (scene/edit/baked_color.hpp).
  enum class Color { network, baked, base } color = Color::network;
  /// Whether float texels become bytes (scene/edit/lattice_bytes.hpp).
  bool byte_texels = false;

  bool operator==(const Edits&) const = default;
};

/// The edits that differ from their defaults, in words: "12 of 40 triangles, lattice level at most
/// 3, baked colour, 8 bits per texel channel"; "none".
std::string describe(const Edits& edits);

/// The members that differ from their defaults: "keeps_face", "lattice_level", "color",
/// "byte_texels".
std::vector<std::string> names_of(const Edits& edits);

/// The reason why these edits do not apply to this soup (a level out of range, a wrong number of
/// faces, all faces removed), or nullopt.
std::optional<std::string> defect(const Edits& edits, const TriangleSoup& soup);

/// The subset of the edits that changes this soup.
Edits effective(const Edits& edits, const TriangleSoup& soup);

/// The edited soup; edits run in the order of their declaration. Requires that neither has a
/// defect(). `progress` is called with the completed fraction of the current edit, 0..1; it may
/// throw to cancel. Memory in addition to the result: one more soup.
TriangleSoup edited(TriangleSoup soup, const Edits& edits,
                    const std::function<void(double)>& progress = {});

}  // namespace tureen
