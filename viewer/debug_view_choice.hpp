// The debug view shown by the window.
#pragma once

#include "runtime/debug_views/debug_view.hpp"

namespace tureen::viewer {

struct DebugViewChoice {
  DebugView what = DebugView::color;
  FeatureChoice features = {};

  bool operator==(const DebugViewChoice& other) const {
    return what == other.what && features.first == other.features.first &&
           features.count == other.features.count;
  }
};

}  // namespace tureen::viewer
