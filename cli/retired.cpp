#include "cli/retired.hpp"

namespace tureen::cli {

namespace {

struct Retired {
  const char* command;
  const char* name;  // empty: the command itself
  const char* replacement;
};

constexpr Retired retired[] = {
    {"bench", "--csv", "-o FOLDER writes bench.json"},
    {"bench", "--import", "tureen report FILE.. shows several results side by side"},
    {"bench", "--plots", "-o FOLDER writes bench.json, and tureen report FILE plots it"},
    {"plot", "", "tureen report LOG.. plots training logs"},
    {"tradeoff", "--import", "tureen report FILE.. joins the results of several scenes"},
};

}  // namespace

std::string replacement_of(const std::string& command, const std::string& name) {
  for (const Retired& each : retired)
    if (command == each.command && name == each.name) return each.replacement;
  return {};
}

}  // namespace tureen::cli
