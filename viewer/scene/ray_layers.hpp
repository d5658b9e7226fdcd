// The layers of a document for rays.
#pragma once

#include <map>
#include <memory>
#include <vector>

#include "viewer/scene/scene_source.hpp"

namespace tureen::viewer {

class RayLayers {
 public:
  /// The document's layers; splats with its profile. The same document gives the same primitives,
  /// so that tracing::TracedImages::sync() keeps their trees.
  std::vector<DocumentLayer> of(const SceneSource& source);

 private:
  struct Changed {
    std::shared_ptr<const Primitives> stored, drawn;
  };
  std::map<LayerId, Changed> changed_;  // layers whose own profile is another one
};

}  // namespace tureen::viewer
