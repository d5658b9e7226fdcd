// Places of layers as text, in the order of describe():
// "guitar=at:1,2,3/turn:0,0,30/scale:2/mirror". The argument of --place; the window writes it into
// the commands that it copies.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scene/scene.hpp"
#include "scene/similarity.hpp"

namespace tureen {

/// What changes of a layer. The parts without a value stay as they are.
struct PlaceChange {
  std::string layer;                                     // its label()
  std::optional<glm::dvec3> position = {}, angles = {};  // as in Similarity
  std::optional<double> scale = {};                      // > 0
  std::optional<bool> mirror = {}, visible = {};
};

/// Reads NAME=PARTS. The parts, separated by slashes, are at:X,Y,Z, turn:X,Y,Z, scale:FACTOR,
/// mirror, mirror:no, hidden and visible, each at most once. NAME ends at the last "=". Throws
/// UsageError, which lists the parts.
PlaceChange parse_place(std::string_view text);

/// All parts, with digits that read back as the same numbers.
std::string place_text(const std::string& layer, const Similarity& place, bool visible);

/// Changes the layers in order. "layer 2" is also the second layer, if no layer has this name.
/// Throws UsageError, which lists the labels, for an unknown layer, and for one of several layers
/// with the same name.
void place_layers(Scene& scene, const std::vector<PlaceChange>& changes);

}  // namespace tureen
