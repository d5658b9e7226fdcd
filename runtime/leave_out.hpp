// The things that a plan may leave out of a frame because this scene does not need them, by name,
// so that each can be kept alone: to measure what leaving it out gains, or to look for a fault.
// docs/leaving-out.md says for each how it is found, why nothing is lost, and what it gains.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

namespace tureen {

enum class LeaveOut : std::uint8_t {
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
struct LeaveOutName {
  LeaveOut what;
  const char* name;   // "alpha-test"
  const char* title;  // "the alpha test of opaque faces"
};

/// All of them, in the order of the enumeration.
std::span<const LeaveOutName> leave_out_names();

const char* name_of(LeaveOut what);

/// By name; nothing when there is none of that name.
std::optional<LeaveOut> leave_out_named(std::string_view name);

/// Some of them.
class LeaveOutSet {
 public:
  constexpr LeaveOutSet() = default;
  static constexpr LeaveOutSet all() { return LeaveOutSet(~std::uint32_t(0)); }
  static constexpr LeaveOutSet only(LeaveOut what) { return LeaveOutSet(bit(what)); }

  constexpr bool has(LeaveOut what) const { return (bits_ & bit(what)) != 0; }
  constexpr void add(LeaveOut what) { bits_ |= bit(what); }
  constexpr LeaveOutSet without(LeaveOut what) const { return LeaveOutSet(bits_ & ~bit(what)); }
  constexpr bool operator==(const LeaveOutSet&) const = default;

 private:
  constexpr explicit LeaveOutSet(std::uint32_t bits) : bits_(bits) {}
  static constexpr std::uint32_t bit(LeaveOut what) { return std::uint32_t(1) << int(what); }
  std::uint32_t bits_ = 0;
};

}  // namespace tureen
