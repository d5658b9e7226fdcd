// How a scene may be drawn faster at a known error: one field a knob (docs/tradeoff.md). Plain
// data, kept with the scene and in its file; the runtime obeys it (runtime/plan.hpp) after it has
// looked at four views (runtime/preset_check.hpp).
//
// What is no knob: the precision of the color MLP, which devices choose themselves. The oracle
// emulates it, so that its error can be reported (runtime/oracle/oracle.hpp).
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "soup/lattice.hpp"

namespace tureen {

struct TriangleSoup;

/// A default preset draws the scene faithfully: as it is stored, once a pixel.
struct RenderPreset {
  // -- knobs that change the data; lattice textures alone heed the first four ---------------------

  /// No face has a lattice above this level: 0..lattice::max_level. Finer ones are projected
  /// (soup/lattice_projection.hpp).
  int lattice_level = lattice::max_level;

  /// Bits a channel that a texel has on the device at most: 32 (float; as stored), 16 (half), 8 or
  /// 4. Texels that are stored with fewer stay as they are.
  int texel_bits = 32;

  /// What turns texels into colour.
  enum class Color {
    network,    // the color MLP, where there is one
    harmonics,  // of the network's colour, baked into every texel (soup/baked_color.hpp)
    base,       // the network is left out: features 0..2
  };
  Color color = Color::network;
  /// Of Color::harmonics: 0 (one colour for all directions), 1 or 2.
  int harmonics_degree = 2;

  /// The part of the faces that is drawn, the most visible ones: above 0, at most 1.
  double triangle_fraction = 1.0;
  /// Which faces those are: one a face of the soup, 1 for those that are drawn and 0 for the others
  /// (runtime/visibility_count.hpp finds them). Empty exactly where triangle_fraction is 1.
  std::vector<std::uint8_t> keeps_face = {};

  // -- knobs that change the drawing --------------------------------------------------------------

  /// What a deferred plan keeps of the winning fragment until it is shaded.
  enum class FeatureStorage {
    visibility,  // which face, and where on it; features are fetched in full precision
    rgba16f,     // the features themselves, half floats
    rgba8,       // the same, a byte each, as the published viewer does
  };
  FeatureStorage feature_storage = FeatureStorage::visibility;

  /// Where colours are made: by the plan's choice, once a pixel, or once a fragment.
  enum class Site { automatic, deferred, forward };
  Site site = Site::automatic;

  /// Rows and columns that are drawn for each of the picture's: 0.25 .. 1. The picture is enlarged
  /// bilinearly.
  double resolution_scale = 1.0;

  /// Samples a pixel along each axis: 1..8. The pixel is their mean.
  int supersampling = 1;

  /// Multisampling with alpha to coverage, samples a pixel: 0 (none), 2, 4 or 8. Forward alone.
  int alpha_to_coverage = 0;

  // -- what was promised --------------------------------------------------------------------------

  /// PSNR in dB against faithful pictures that four views had when it was chosen: 0 .. 100, or
  /// nothing where nobody measured. The runtime draws faithfully where the four say otherwise.
  std::optional<double> promised_psnr_db = {};
};

/// Whether every knob is at its default, whatever was promised.
bool is_faithful(const RenderPreset& preset);

/// Whether the knobs that change the data are at their defaults.
bool keeps_data(const RenderPreset& preset);

/// The knobs that are not at their defaults, in words: "lattice level at most 3, 8 bits a texel
/// channel"; "faithful" where there are none.
std::string describe(const RenderPreset& preset);

/// Every knob as `asked` has it where that is not at its default, else as `preset` has it; the
/// promise is that of `preset`. Resolution scale and supersampling are one knob.
RenderPreset combined(RenderPreset preset, const RenderPreset& asked);

/// Why these knobs cannot be obeyed by anything (one outside of its range, two that exclude each
/// other), or nothing.
std::optional<std::string> defect(const RenderPreset& preset);

/// The same, and why they cannot be obeyed for this soup: keeps_face has another number of faces.
std::optional<std::string> defect(const RenderPreset& preset, const TriangleSoup& soup);

}  // namespace tureen
