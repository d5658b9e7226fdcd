#include "cli/options/debug_view_option.hpp"

#include <fmt/format.h>

#include "base/error.hpp"
#include "cli/options/values.hpp"

namespace tureen::cli {

namespace {

DebugView debug_view_of(const std::string& name) {
  if (const auto known = debug_view_named(name)) return *known;
  std::vector<std::string> names;
  for (const DebugViewName& known : debug_view_names()) names.emplace_back(known.name);
  throw unknown_word("--debug-view", name, names);
}

/// "3" or "4-6".
FeatureChoice parse_features(const std::string& text) {
  constexpr int most = 7;  // MobileNeRF has 8 features; why_not() reports that a lattice has 7
  const std::size_t dash = text.find('-');
  const int first = parse_integer(text.substr(0, dash), 0, most);
  const int last =
      dash == std::string::npos ? first : parse_integer(text.substr(dash + 1), 0, most);
  if (last < first || last > first + 2)
    throw UsageError("--debug-view features:" + text +
                     ": needs one to three consecutive features, such as 3 or 4-6");
  return {first, last - first + 1};
}

}  // namespace

DebugViewOption parse_debug_view(const std::string& text) {
  const std::size_t colon = text.find(':');
  DebugViewOption show{.what = debug_view_of(text.substr(0, colon))};
  if (colon == std::string::npos) return show;
  if (show.what != DebugView::features)
    throw UsageError("--debug-view " + text +
                     ": only features takes numbers, such as features:4-6");
  show.features = parse_features(text.substr(colon + 1));
  return show;
}

Option add_debug_view_option(Command& command, DebugViewOption& show) {
  return command.add_option(
      "--debug-view,--show NAME",
      [&show](const std::string& text) { show = parse_debug_view(text); },
      "debug view instead of the final colour: depth, normals, triangle-id, texels, alpha, "
      "mlp-weight, features (features:3 as grey, features:4-6 as red, green, blue), overdraw, "
      "wireframe, holes, median-depth, opacity, sigma, contributions, order or quarter "
      "(docs/debug-views.md)");
}

std::vector<std::string> legend_lines(const Legend& legend) {
  std::vector<std::string> lines;
  for (const auto& [color, text] : legend)
    lines.push_back(fmt::format("#{:02x}{:02x}{:02x} {}", color.r, color.g, color.b, text));
  return lines;
}

}  // namespace tureen::cli
