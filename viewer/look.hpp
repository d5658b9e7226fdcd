// What of the soup the window shows.
#pragma once

#include "runtime/debug_views/inspection.hpp"

namespace tureen::viewer {

struct Look {
  Inspection what = Inspection::color;
  FeatureChoice features = {};

  bool operator==(const Look& other) const {
    return what == other.what && features.first == other.features.first &&
           features.count == other.features.count;
  }
};

}  // namespace tureen::viewer
