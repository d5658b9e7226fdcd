// The result of measuring a scene against photographs: as JSON, and the words that name what a PSNR
// was measured on, without which two of them cannot be compared.
#pragma once

#include <string>
#include <vector>

#include "base/json/json_text.hpp"
#include "cli/options/dataset_argument.hpp"
#include "jobs/eval/evaluation.hpp"

namespace tureen::cli {

/// What was measured. The references must outlive it.
struct EvalSubject {
  const std::string& scene;
  const DatasetArgument& dataset;
  DatasetPart split;
  const EvaluationOptions& evaluation;
};

/// --split, and --ssim-border.
void add_split_option(Command& command, DatasetPart& split);
void add_eval_border(Command& command, MetricOptions& metrics);

/// The photographs of the split, moved out of the dataset. Throws InputError if there are none.
std::vector<Photograph> photographs_of(Dataset& dataset, const EvalSubject& subject);

/// "13 photographs (test) of 473 x 266 (--scale 0.5), one sample per pixel; SSIM with border
/// valid".
std::string describe(const EvalSubject& subject, std::span<const Photograph> photographs);

/// The output of `tureen eval --json`. `output`: paths, first the image of each view.
Json to_json(const EvalSubject& subject, const Evaluation& result,
             const std::vector<std::string>& output);

}  // namespace tureen::cli
