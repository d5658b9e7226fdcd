// A small result of `tureen tradeoff`, tests/cli/tradeoff.json, and another one of the same knobs.
#pragma once

#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

namespace tureen::test {

/// Of the scene lego: drawing has, in this order, defaults, published pipeline, lattice level 2,
/// shaded once a fragment, generic defaults and an emulated MLP; antialiasing defaults and half the
/// resolution.
inline nlohmann::json lego() {
  std::ifstream stream(std::string(TUREEN_SOURCE_DIR) + "/tests/cli/tradeoff.json");
  return nlohmann::json::parse(stream);
}

/// The same of the scene chair, which takes four times as long and comes 10 dB less near.
inline nlohmann::json chair() {
  nlohmann::json json = lego();
  json["scene"]["name"] = "chair";
  json["scene"]["path"] = "chair.glb";
  for (const char* panel : {"drawing", "antialiasing"}) {
    nlohmann::json& own = json[panel];
    own["r1"]["psnr_db"] = own["r1"]["psnr_db"].get<double>() - 10;
    for (nlohmann::json& each : own["configurations"]) {
      for (const char* key : {"ms", "ms_median", "ms_p95", "ms_spread"})
        if (!each[key].is_null()) each[key] = each[key].get<double>() * 4;
      each["e_render"]["psnr_db"] = each["e_render"]["psnr_db"].get<double>() - 10;
    }
  }
  return json;
}

}  // namespace tureen::test
