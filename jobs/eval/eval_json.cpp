#include "jobs/eval/eval_json.hpp"

namespace tureen::results {

Json to_json(const ViewMetrics& metrics, bool with_flip) {
  Json json = Json::object();
  if (!metrics.name.empty()) json["name"] = metrics.name;
  json["psnr_db"] = metrics.psnr_db;
  json["ssim"] = metrics.ssim;
  if (with_flip) json["flip"] = metrics.flip;
  json["holes"] = metrics.holes;
  json["specks"] = metrics.specks;
  return json;
}

}  // namespace tureen::results
