// Errors against photographs, as JSON.
#pragma once

#include "base/json/json_text.hpp"
#include "jobs/eval/evaluation.hpp"

namespace tureen::results {

/// {"name": .., "psnr_db": .., "ssim": .., "flip": .., "holes": .., "specks": ..}; "name" only if
/// it is not empty, "flip" only if `with_flip`.
Json to_json(const ViewMetrics& metrics, bool with_flip);

}  // namespace tureen::results
