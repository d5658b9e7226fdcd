// The debug view shown by the window.
#pragma once

#include "runtime/debug_views/debug_view.hpp"

namespace tureen::viewer {

struct DebugViewChoice {
  DebugView what = DebugView::color;
  FeatureChoice features = {};

  bool operator==(const DebugViewChoice& other) const = default;
};

}  // namespace tureen::viewer
