// What is drawn for this scene on this device, and what was left out.
#pragma once

#include <string>
#include <vector>

namespace tureen {

struct RenderPlan {
  /// For people, in order: how the scene is drawn, then one for each thing left out, with the
  /// measured margin.
  std::vector<std::string> sentences;
};

}  // namespace tureen
