// The plan of one layer of splats.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "runtime/plan/specialisation.hpp"
#include "scene/quality.hpp"
#include "scene/splats.hpp"
#include "splatting/layer.hpp"

namespace tureen {

/// The way to blend splats.
enum class SplatBlending {
  automatic,  // tiles on software OpenGL, where they can; otherwise raster
  raster,     // the device's rasteriser
  tiles,      // the processor's vectors, tile by tile (splatting/)
};
/// In options, in the order of the enumeration.
inline constexpr std::array<const char*, 3> splat_blending_names{"auto", "raster", "tiles"};

/// The texture in which splats are blended by raster.
enum class SplatFormat {
  automatic,  // rgba16 if device and colours allow it and min_alpha is at least 1/255; otherwise
              // rgba32f if the device blends it, or rgba16f
  rgba32f,
  rgba16,   // fractions of the largest colour: 57 dB and more
  rgba16f,  // about 52 dB: near an alpha of 1 its step is 1/2048, and faint splats vanish
};

inline constexpr std::size_t splats_per_chunk = 65'536;

/// The method of drawing one layer of splats.
struct SplatPlan {
  splatting::LayerKind kind = 0;
  SplatProfile profile;
  /// Whether splats are also culled by the rules of the authors' code that depend on the resolution
  /// (oracle/published_culls.hpp states them).
  bool as_published = false;
  /// Of the highest band with a coefficient other than 0, up to the scene's degree.
  int harmonics_degree = 0;
  int colors_per_splat = 1;  // or 3, with SplatColor::per_corner
  /// No drawn splat has a larger colour, seen from any direction. At least 1.
  float largest_color = 1;
  /// Drawn splats, in the scene's order: all, or with transparent_splats those whose opacity
  /// reaches the profile's min_alpha.
  std::vector<std::uint32_t> drawn;
  /// bounds() of each chunk of `drawn`: splats_per_chunk splats, the last one fewer. Readers sort
  /// splats along the Morton curve, so chunks are small in space.
  std::vector<Bounds> chunks;

  /// transparent_splats, harmonics_bands, hidden_splats.
  std::vector<AppliedSpecialisation> applied;

  // Facts about the splats, for messages.

  std::string kernel;      // kernel_name() and the name of the profile
  std::size_t splats = 0;  // all

  bool applies(Specialisation what) const;
};

struct SplatPreferences {
  bool specialise = true;  // if false, every splat is drawn with all bands
  SpecialisationSet specialisations = SpecialisationSet::all();
  std::optional<SplatProfile> profile = {};  // default: the splats' own
  bool as_published = false;                 // SplatPlan::as_published
};

/// Whether tiles blend the splats of a frame. They have one order, so one way blends all layers.
/// `layers` is the number of layers of splats, `for_tiles` of those that tiles can blend. Throws
/// UsageError for SplatOrder::exact, unless tiles can blend all.
bool blends_in_tiles(Quality::SplatOrder order, std::size_t layers, std::size_t for_tiles);

/// O(data). The splats have no defect(). Throws UsageError for a profile that the kernel does not
/// support.
SplatPlan make_splat_plan(const Splats& splats, const SplatPreferences& preferences = {});

}  // namespace tureen
