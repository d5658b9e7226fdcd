#include "trainer/common/config_table.hpp"

#include <algorithm>

#include "base/suggestion.hpp"

namespace tureen::trainer {

void require_known_fields(const JsonView& root, std::span<const std::string> names) {
  const std::vector<std::string> known(names.begin(), names.end());
  std::string unknown, hint;
  for (const auto& [key, ignored] : root.value().items())
    if (std::find(known.begin(), known.end(), key) == known.end()) {
      unknown += (unknown.empty() ? "\"" : "; \"") + key + "\" is not a training constant";
      const std::string near = did_you_mean(key, known);
      hint += (hint.empty() || near.empty() ? "" : " ") + near;
    }
  if (!unknown.empty()) root.fail(unknown, hint);
}

}  // namespace tureen::trainer
