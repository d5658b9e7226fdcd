#include "cli/files/eval_result.hpp"

#include <fmt/format.h>

#include <iterator>

#include "base/decimal_text.hpp"
#include "base/error.hpp"
#include "jobs/bench/plan_json.hpp"
#include "jobs/eval/eval_json.hpp"

namespace tureen::cli {

namespace {

const char* split_name(DatasetPart split) {
  constexpr const char* names[] = {"train", "test", "all"};
  return names[std::size_t(split)];
}

}  // namespace

void add_split_option(Command& command, DatasetPart& split) {
  add_choice<DatasetPart>(
      command, "--split NAME", split,
      {{"test", DatasetPart::test}, {"train", DatasetPart::train}, {"all", DatasetPart::all}},
      "photographs to use: test (default), train or all");
}

void add_eval_border(Command& command, MetricOptions& metrics) {
  std::vector<std::pair<std::string, SsimBorder>> borders;
  for (const SsimBorder border : {SsimBorder::valid, SsimBorder::zero_pad, SsimBorder::uniform7})
    borders.emplace_back(name(border), border);
  add_choice<SsimBorder>(command, "--ssim-border MODE", metrics.ssim_border, borders,
                         "SSIM window at the image border: valid (default, as in DiffSoup on "
                         "photographs), zero_pad (3DGS), or uniform7 (scikit-image)");
}

std::vector<Photograph> photographs_of(Dataset& dataset, const EvalSubject& subject) {
  std::vector<Photograph> photographs = std::move(dataset.train);
  photographs.insert(photographs.end(), std::make_move_iterator(dataset.test.begin()),
                     std::make_move_iterator(dataset.test.end()));
  if (photographs.empty())
    throw InputError(
        {subject.dataset.path},
        std::string("the dataset has no photographs for --split ") + split_name(subject.split));
  return photographs;
}

std::string describe(const EvalSubject& subject, std::span<const Photograph> photographs) {
  const Camera& first = photographs.front().camera;
  return fmt::format("{} ({}) of {} x {} (--scale {:g}), {}; SSIM with border {}",
                     counted(photographs.size(), "photograph"), split_name(subject.split),
                     first.width, first.height, subject.dataset.options.scale,
                     describe(subject.evaluation.plan.quality),
                     name(subject.evaluation.metrics.ssim_border));
}

Json to_json(const EvalSubject& subject, const Evaluation& result,
             const std::vector<std::string>& output) {
  const bool with_flip = subject.evaluation.metrics.with_flip;
  const Quality& quality = subject.evaluation.plan.quality;
  Json views = Json::array();
  for (const ViewMetrics& view : result.views) views.push_back(results::to_json(view, with_flip));
  return {{"views", views},
          {"mean", results::to_json(result.mean, with_flip)},
          {"scene", subject.scene},
          {"dataset", subject.dataset.path},
          {"split", split_name(subject.split)},
          {"scale", subject.dataset.options.scale},
          {"samples_per_pixel", quality.supersampling * quality.supersampling},
          {"ssim_border", name(subject.evaluation.metrics.ssim_border)},
          {"context", result.context},
          {"renderer", result.renderer},
          {"plan", result.plan},
          {"specialisations", results::specialisations_json(result.specialisations)},
          {"output", output}};
}

}  // namespace tureen::cli
