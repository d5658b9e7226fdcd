// Small random soups of every appearance, with options. They mix ordinary faces with difficult
// ones: opaque, transparent, constant or affine faces, needles, faces without area, faces through
// the eye.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "scene/camera.hpp"
#include "scene/triangle_soup.hpp"
#include "tests/support/random.hpp"

namespace tureen::test {

enum class Kind {
  face_colors,
  vertex_colors,
  face_harmonics,
  vertex_harmonics,
  lattice,      // features are the colour
  lattice_mlp,  // features are the input of a colour MLP
  uv_textures,
  uv_textures_mlp,
};

inline constexpr std::array all_kinds = {
    Kind::face_colors, Kind::vertex_colors, Kind::face_harmonics, Kind::vertex_harmonics,
    Kind::lattice,     Kind::lattice_mlp,   Kind::uv_textures,    Kind::uv_textures_mlp};

std::string to_string(Kind kind);

struct SoupOptions {
  Kind kind = Kind::face_colors;
  int faces = 200;
  /// Vertices are centre + size * N(0, 1), centres uniform in the unit ball.
  double size = 0.15;
  bool shared_vertices = false;  // faces take their vertices from a common pool
  bool degenerate = false;       // mixes in faces without area and needles
  int level = -1;                // of the lattice, 0..7; -1 mixes them
  bool float_texels = false;
  int degree = 3;  // of the harmonics
  ViewConvention view = ViewConvention::eye_to_surface;
  UvMaterial::Filter filter = UvMaterial::Filter::linear;
};

/// The soup has no defect(). Equal for equal arguments.
TriangleSoup random_soup(std::uint64_t seed, const SoupOptions& options);

/// DiffSoup's 16-16-16-3 for lattices: blends with channel 3, harmonics of the direction.
ColorMlp random_lattice_mlp(Random& random);

/// MobileNeRF's 11-16-16-3 for pairs of feature images: no blending, the plain direction.
ColorMlp random_uv_mlp(Random& random);

/// A camera outside the unit ball, in any direction, aimed at it, with an off-centre principal
/// point.
Camera random_camera(Random& random, int width, int height);

}  // namespace tureen::test
