// Specialisations: work that a plan skips because the scene does not need it. Each has a name and
// can be disabled alone, to measure its gain or to locate a fault. docs/specialisations.md has the
// condition, the bound and the gain of each.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

namespace tureen {

enum class Specialisation : std::uint8_t {
  alpha_test,          // no alpha test for fully opaque faces
  transparent_faces,   // fully transparent faces are not drawn
  coincident_faces,    // faces behind an opaque one with the same corners are not drawn
  small_triangles,     // each frame skips faces that cover no pixel centre
  shading_pass,        // inexpensive colours are computed in the only pass
  background,          // pixels without a face are not shaded
  interpolation,       // three equal vertex colours become one colour a face
  harmonics_bands,     // bands that change no colour are not evaluated
  color_mlp,           // a network that is never blended in is not evaluated
  view_direction,      // a network ignores a direction that changes no colour
  weight_uniforms,     // weights are constants of the shader
  dead_neurons,        // neurons that never fire, and weights of zero, are not computed
  latent_features,     // features 4 and above that are constant or have no weight are not read
  constant_lattices,   // lattices with one colour become one colour a face
  affine_texels,       // affine faces keep only their corner texels
  transparent_splats,  // splats that are too transparent everywhere are not drawn
  hidden_splats,       // splats behind closed pixels are not drawn
};

/// One specialisation, as a plan applied it.
struct AppliedSpecialisation {
  Specialisation what = {};
  /// `count`: faces, splats, bands or hidden neurons to which this specialisation applies. `total`:
  /// all that it examined. Both are 0 if this specialisation counts nothing.
  std::size_t count = 0, total = 0;
  /// Largest change of a colour, in steps of 8 bits: 0 (exact up to rounding) to 0.5.
  double margin = 0;

  bool operator==(const AppliedSpecialisation&) const = default;
};

/// The names of one specialisation, for messages and for the command line.
struct SpecialisationName {
  Specialisation what;
  const char* name;   // "alpha-test"
  const char* title;  // "no alpha test for opaque faces"
};

/// All names, in the order of the enumeration.
std::span<const SpecialisationName> specialisation_names();

const char* name_of(Specialisation what);

/// The specialisation with this name, or nullopt.
std::optional<Specialisation> specialisation_named(std::string_view name);

/// A set of specialisations.
class SpecialisationSet {
 public:
  constexpr SpecialisationSet() = default;
  static constexpr SpecialisationSet all() { return SpecialisationSet(~std::uint32_t(0)); }
  static constexpr SpecialisationSet only(Specialisation what) {
    return SpecialisationSet(bit(what));
  }

  constexpr bool has(Specialisation what) const { return (bits_ & bit(what)) != 0; }
  constexpr void add(Specialisation what) { bits_ |= bit(what); }
  constexpr SpecialisationSet without(Specialisation what) const {
    return SpecialisationSet(bits_ & ~bit(what));
  }
  constexpr bool operator==(const SpecialisationSet&) const = default;

 private:
  constexpr explicit SpecialisationSet(std::uint32_t bits) : bits_(bits) {}
  static constexpr std::uint32_t bit(Specialisation what) { return std::uint32_t(1) << int(what); }
  std::uint32_t bits_ = 0;
};

}  // namespace tureen
