#include "cli/options/retired.hpp"

namespace tureen::cli {

namespace {

struct Retired {
  const char* command;
  const char* name;  // empty: the command itself
  const char* replacement;
};

constexpr const char* instead_of_presets =
    "tureen tradeoff --write OUT.glb writes the reduced scene; --supersample overrides its quality";

constexpr Retired retired[] = {
    {"bench", "--csv", "-o FOLDER writes bench.json"},
    {"bench", "--import", "tureen report FILE.. shows several results side by side"},
    {"bench", "--plots", "-o FOLDER writes bench.json, and tureen report FILE plots it"},
    {"bench", "--preset", instead_of_presets},
    {"eval", "--preset", instead_of_presets},
    {"plot", "", "tureen report LOG.. plots training logs"},
    {"render", "--preset", instead_of_presets},
    {"tradeoff", "--import", "tureen report FILE.. joins the results of several scenes"},
    {"tradeoff", "--write-preset",
     "--write OUT.glb writes the scene with its data reduced as chosen"},
};

}  // namespace

std::string replacement_of(const std::string& command, const std::string& name) {
  for (const Retired& each : retired)
    if (command == each.command && name == each.name) return each.replacement;
  return {};
}

}  // namespace tureen::cli
