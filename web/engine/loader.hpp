// A scene that an instance reads and prepares for the device of another one.
#pragma once

#include <deque>
#include <optional>
#include <vector>

#include "runtime/prepared_scene.hpp"

namespace tureen::web {

struct Loader {
  std::optional<Scene> scene;
  std::deque<TriangleSoup> reduced;       // lower lattice levels, to save memory; stays in place
  std::vector<PlacedLayer> placed;        // the scene's layers, or their reductions
  std::optional<PreparedScene> prepared;  // reads the placed layers
};

}  // namespace tureen::web
