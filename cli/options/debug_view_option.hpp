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

/// Parses "depth" or "features:4-6". Throws UsageError with the known names.
DebugViewOption parse_debug_view(const std::string& text);

/// The meaning of each colour, one per line: "#ff8080 x".
std::vector<std::string> legend_lines(const Legend& legend);

}  // namespace tureen::cli
