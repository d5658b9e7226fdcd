// Changes to a soup's data that make it cheaper to draw and to store. What they cost is measured by
// `tureen tradeoff`.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "scene/lattice.hpp"
#include "scene/triangle_soup.hpp"

namespace tureen {

/// The default changes nothing. Level, colour and bytes apply to lattice textures only.
struct Edits {
  /// The faces that are kept, one entry a face, 0 for those that go; empty: all. At least one
  /// stays.
  std::vector<std::uint8_t> keeps_face = {};
  /// No face has a lattice above this level, 0..lattice::max_level: finer ones are projected
  /// (scene/edit/lattice_levels.hpp).
  int lattice_level = lattice::max_level;
  /// The way from texels to colour (scene/edit/baked_color.hpp).
  enum class Color { network, baked, base } color = Color::network;
  /// Texels become bytes where they are floats (scene/edit/lattice_bytes.hpp).
  bool byte_texels = false;

  bool operator==(const Edits&) const = default;
};

/// The edits that are not at their defaults, in words: "12 of 40 triangles, lattice level at most
/// 3, baked colour, 8 bits a texel channel"; "none".
std::string describe(const Edits& edits);

/// The members that are not at their defaults: "keeps_face", "lattice_level", "color",
/// "byte_texels".
std::vector<std::string> names_of(const Edits& edits);

/// Why these edits make no sense for this soup (a level outside of its range, another number of
/// faces, none kept), or nothing.
std::optional<std::string> defect(const Edits& edits, const TriangleSoup& soup);

/// The edits that would change something of this soup.
Edits effective(const Edits& edits, const TriangleSoup& soup);

/// The soup with its edits, in the order in which they are declared. Neither has a defect().
/// `progress` is called now and then with the fraction of one edit done, 0..1, and may throw to
/// abandon the work. Memory beside the result: one more soup.
TriangleSoup edited(TriangleSoup soup, const Edits& edits,
                    const std::function<void(double)>& progress = {});

}  // namespace tureen
