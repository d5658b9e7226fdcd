#include "cli/plan_json.hpp"

#include "cli/json_reading.hpp"

namespace tureen::cli {

Json specialisations_json(std::span<const AppliedSpecialisation> specialisations) {
  Json list = Json::array();
  for (const AppliedSpecialisation& each : specialisations)
    list.push_back({{"name", name_of(each.what)},
                    {"count", each.count},
                    {"total", each.total},
                    {"margin", each.margin}});
  return list;
}

std::vector<AppliedSpecialisation> specialisations_of(const JsonView& configuration) {
  const auto applied = configuration.find("specialisations");
  if (!applied) return {};
  return list(*applied, [](const JsonView& each) {
    const auto what = specialisation_named(each["name"].text());
    if (!what) each["name"].fail("is no specialisation");
    const auto count = [&](const char* key) { return std::size_t(integer(each[key])); };
    return AppliedSpecialisation{*what, count("count"), count("total"), each["margin"].number()};
  });
}

}  // namespace tureen::cli
