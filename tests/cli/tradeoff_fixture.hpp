// A small result of `tureen tradeoff`, tests/cli/tradeoff.json.
#pragma once

#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

namespace tureen::test {

/// A result for the scene lego. The drawing panel has, in this order: defaults, baseline, lattice
/// level 2, shaded once a fragment, generic defaults, and baked colour. The antialiasing panel has
/// defaults and half the resolution.
inline nlohmann::json lego() {
  std::ifstream stream(std::string(TUREEN_SOURCE_DIR) + "/tests/cli/tradeoff.json");
  return nlohmann::json::parse(stream);
}

}  // namespace tureen::test
