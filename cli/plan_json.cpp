#include "cli/plan_json.hpp"

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

}  // namespace tureen::cli
