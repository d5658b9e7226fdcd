// Small training views for tests of splats.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "trainer/common/training_views.hpp"

namespace tureen::trainer::test {

/// Views of a bright disc on black, from around.
inline std::vector<TrainingView> views_of_a_disc() {
  std::vector<TrainingView> views;
  for (int k = 0; k < 6; ++k) {
    TrainingView& view = views.emplace_back();
    const double turn = k * 1.05;
    view.camera =
        look_at({4 * std::cos(turn), 4 * std::sin(turn), 1}, {0, 0, 0}, {0, 0, 1}, 0.6, 40, 33);
    for (int i = 0; i < 3 * 40 * 33; ++i) {
      const int x = i % 40 - 20, y = i / 40 % 33 - 16;
      view.target.push_back(x * x + y * y < 80 ? std::uint8_t(120 + 40 * (i / (40 * 33))) : 0);
    }
  }
  return views;
}

}  // namespace tureen::trainer::test
