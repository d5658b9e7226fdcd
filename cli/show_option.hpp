// --show: what a picture shows of a soup instead of its colours.
#pragma once

#include <string>
#include <vector>

#include "cli/arguments.hpp"
#include "runtime/debug_views/inspection.hpp"

namespace tureen::cli {

struct ShowOption {
  Inspection what = Inspection::color;
  FeatureChoice features = {};
};

/// --show NAME; of features also which: features:3, features:4-6. `show` must live until the
/// arguments are parsed.
Option add_show_option(Command& command, ShowOption& show);

/// "depth", "features:4-6": throws UsageError with what there is.
ShowOption parse_show(const std::string& text);

/// What colours mean, a line each: "#ff8080 x".
std::vector<std::string> legend_lines(const Legend& legend);

}  // namespace tureen::cli
