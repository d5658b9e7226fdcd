#include "jobs/bench/plan_json.hpp"

#include "jobs/bench/json_reading.hpp"

namespace tureen::results {

Json specialisations_json(std::span<const AppliedSpecialisation> specialisations) {
  Json list = Json::array();
  for (const AppliedSpecialisation& each : specialisations)
    list.push_back({{"name", name_of(each.what)},
                    {"count", each.count},
                    {"total", each.total},
                    {"margin", each.margin}});
  return list;
}

std::vector<AppliedSpecialisation> specialisations_of(const JsonView& list) {
  std::vector<AppliedSpecialisation> known;
  for (std::size_t i = 0; i < list.size(); ++i) {
    const JsonView each = list.at(i);
    const auto count = [&](const char* key) { return std::size_t(integer(each[key])); };
    // Names from other versions are skipped, so that their results stay readable.
    if (const auto what = specialisation_named(each["name"].text()))
      known.push_back({*what, count("count"), count("total"), each["margin"].number()});
  }
  return known;
}

}  // namespace tureen::results
