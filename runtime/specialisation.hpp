// The things that a plan may leave out of a frame because this scene does not need them, by name,
// so that each can be kept alone: to measure what leaving it out gains, or to look for a fault.
// docs/leaving-out.md says for each how it is found, why nothing is lost, and what it gains.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

namespace tureen {

enum class Specialisation : std::uint8_t {
  alpha_test,            // of faces that are opaque throughout
  transparent_faces,     // faces that are transparent throughout
  coincident_faces,      // faces behind an opaque one with the same corners
  faces_between_pixels,  // that cover no pixel's centre
  shading_pass,          // where a colour is cheap enough to write at once
  background,            // shading of pixels that no face covers
  interpolation,         // of vertex colours that are equal
  harmonics_bands,       // that nobody sees
  color_mlp,             // a network that never blends in
  view_direction,        // that moves no colour
  weight_uniforms,       // weights become constants of the shader
  dead_neurons,          // that never fire, and weights of zero
  latent_features,       // that are the same everywhere, or have no weight
  constant_lattices,     // lattices where every face has one colour
  affine_texels,         // all but the corners of faces that are affine
};

/// One of them for people and for the command line.
struct SpecialisationName {
  Specialisation what;
  const char* name;   // "alpha-test"
  const char* title;  // "the alpha test of opaque faces"
};

/// All of them, in the order of the enumeration.
std::span<const SpecialisationName> specialisation_names();

const char* name_of(Specialisation what);

/// By name; nothing when there is none of that name.
std::optional<Specialisation> specialisation_named(std::string_view name);

/// Some of them.
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
