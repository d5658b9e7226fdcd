// A scene that an instance reads and prepares for the device of another one.
#pragma once

#include <deque>
#include <optional>
#include <vector>

#include "runtime/prepared_scene.hpp"

namespace tureen::web {

/// Bytes in page and device for splats of `bytes` in memory: the scene and the data for the device
/// in the loader, these data in the page, and on the device with the projected splats.
inline double load_bytes(double splats, double bytes) {
  constexpr double projected = 64;  // four texels of four floats each
  return 4.0 * bytes + projected * splats;
}

struct Loader {
  std::optional<Scene> scene;
  std::deque<TriangleSoup> reduced;       // lower lattice levels, to save memory; stays in place
  std::vector<PlacedLayer> placed;        // the scene's layers, or their reductions
  std::optional<PreparedScene> prepared;  // reads the placed layers
};

}  // namespace tureen::web
