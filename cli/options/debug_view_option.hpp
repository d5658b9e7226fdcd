// --debug-view: a debug view instead of the final colour.
#pragma once

#include <string>
#include <vector>

#include "cli/options/arguments.hpp"
#include "runtime/debug_views/debug_view.hpp"

namespace tureen::cli {

struct DebugViewOption {
  DebugView what = DebugView::color;
  FeatureChoice features = {};
};

/// --debug-view NAME (alias --show); features takes numbers: features:3, features:4-6. `show` must
/// live until the arguments are parsed.
Option add_debug_view_option(Command& command, DebugViewOption& show);

/// "depth", "features:4-6": throws UsageError with what there is.
DebugViewOption parse_debug_view(const std::string& text);

/// What colours mean, a line each: "#ff8080 x".
std::vector<std::string> legend_lines(const Legend& legend);

}  // namespace tureen::cli
