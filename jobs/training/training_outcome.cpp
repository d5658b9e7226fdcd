#include "jobs/training/training_outcome.hpp"

#include "base/error.hpp"
#include "jobs/eval/eval_json.hpp"

namespace tureen {

void evaluate(TrainingOutcome& outcome, const Scene& scene, std::span<const Photograph> views,
              const std::function<void(double)>& progress) {
  EvaluationOptions options;
  options.background = scene.info.background;
  options.progress = progress;
  try {
    outcome.evaluation = evaluate(scene, views, options);
  } catch (const ContextError& error) {
    outcome.why_not_drawn = error.reason();
  } catch (const DeviceLimitError& error) {
    outcome.why_not_drawn = error.reason();
  }
}

Json to_json(const TrainingOutcome& outcome, std::size_t views, double scale) {
  const TrainingSummary& training = outcome.training;
  Json test{{"views", views}};
  if (views > 0) test.update({{"scale", scale}, {"samples_per_pixel", 1}});
  if (outcome.evaluation) {
    test.update(results::to_json(outcome.evaluation->mean, true));
    test["drawn_by"] = outcome.evaluation->renderer;
  } else if (training.run.test_psnr_db) {
    test["psnr_db"] = *training.run.test_psnr_db;
    test["drawn_by"] = "trainer";
  }
  Json json{{"done", true},
            {"steps", training.steps},
            {"seconds", training.run.seconds},
            {name_of(training.primitives.kind), training.primitives.count}};
  for (const OwnFact& result : training.own)
    std::visit([&](const auto& value) { json[result.name] = value; }, result.value);
  json["test"] = test;
  if (training.run.test_psnr_db) json["trainer_psnr_db"] = *training.run.test_psnr_db;
  json["non_finite"] = training.non_finite;
  json["output"] = outcome.output;
  return json;
}

}  // namespace tureen
