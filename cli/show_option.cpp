#include "cli/show_option.hpp"

#include <fmt/format.h>

#include "base/error.hpp"
#include "cli/values.hpp"

namespace tureen::cli {

namespace {

Inspection inspection_of(const std::string& name) {
  if (const auto known = inspection_named(name)) return *known;
  std::vector<std::string> names;
  for (const InspectionName& known : inspection_names()) names.emplace_back(known.name);
  throw unknown_word("--show", name, names);
}

/// "3" or "4-6".
FeatureChoice parse_features(const std::string& text) {
  constexpr int most =
      7;  // MobileNeRF's eight features; a lattice has one less, which is said later
  const std::size_t dash = text.find('-');
  const int first = parse_integer(text.substr(0, dash), 0, most);
  const int last =
      dash == std::string::npos ? first : parse_integer(text.substr(dash + 1), 0, most);
  if (last < first || last > first + 2)
    throw UsageError("--show features:" + text +
                     ": needs one to three consecutive features, such as 3 or 4-6");
  return {first, last - first + 1};
}

}  // namespace

ShowOption parse_show(const std::string& text) {
  const std::size_t colon = text.find(':');
  ShowOption show{.what = inspection_of(text.substr(0, colon))};
  if (colon == std::string::npos) return show;
  if (show.what != Inspection::features)
    throw UsageError("--show " + text + ": only features takes numbers, such as features:4-6");
  show.features = parse_features(text.substr(colon + 1));
  return show;
}

Option add_show_option(Command& command, ShowOption& show) {
  return command
      .add_option(
          "--show", [&show](const std::string& text) { show = parse_show(text); },
          "debug view instead of the final colour: depth, normals, triangle-id, texels, alpha, "
          "mlp-weight, features (features:3 as grey, features:4-6 as red, green, blue), overdraw "
          "or wireframe; draws the stored soup with one sample a pixel (docs/looking.md)")
      .value_name("NAME");
}

std::vector<std::string> legend_lines(const Legend& legend) {
  std::vector<std::string> lines;
  for (const auto& [color, text] : legend)
    lines.push_back(fmt::format("#{:02x}{:02x}{:02x} {}", color.r, color.g, color.b, text));
  return lines;
}

}  // namespace tureen::cli
