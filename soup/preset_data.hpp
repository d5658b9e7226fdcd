// The knobs of a RenderPreset that change the data, turned: the soup that is drawn instead. The
// oracle's picture of it is what the device should show.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "soup/render_preset.hpp"
#include "soup/triangle_soup.hpp"

namespace tureen {

struct PresetSoup {
  /// Triangles are those of the soup it was made of, in their order: RenderPreset::keeps_face is
  /// obeyed by the plan, which leaves faces out.
  TriangleSoup soup;
  /// A sentence a knob, with what it saves: "knob: ..".
  std::vector<std::string> sentences;
};

/// Lattice level, then colour, then texel bits. Nothing where no knob changes anything of this
/// soup. `soup` and `preset` have no defect(). `progress` is called now and then with the fraction
/// done, 0..1, and may throw.
std::optional<PresetSoup> with_preset(const TriangleSoup& soup, const RenderPreset& preset,
                                      const std::function<void(double)>& progress = {});

/// Texels with at most so many bits a channel: 32, 16 (floats that are halves), 8 (bytes) or 4
/// (bytes that are multiples of 17, so that value = (byte / 17) / 15). Alpha keeps its side of
/// alpha_threshold. Harmonics of 16 bits are halves, of fewer one byte each: no device has less.
void reduce_texel_bits(LatticeTexture& texture, int bits);

/// Bits a channel that the texels take on a device that is told to use at most `most`.
int stored_texel_bits(const LatticeTexture& texture, int most);

}  // namespace tureen
