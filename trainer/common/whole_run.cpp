#include "trainer/common/whole_run.hpp"

#include <fmt/format.h>

#include <utility>

#include "trainer/common/held_out.hpp"

namespace tureen::trainer {

RunResult run_to_the_end(Trainable& run, RunRequest request, const Dataset& dataset,
                         const std::function<Scene()>& scene) {
  const auto described = [&] {
    Scene result = scene();
    for (const Photograph& photograph : dataset.train) result.cameras.push_back(photograph.camera);
    const std::span<const float, 3> background = run.background();
    result.info.name = request.name;
    result.info.up = dataset.up;
    result.info.background = {background[0], background[1], background[2]};
    result.info.source = fmt::format("Tureen trainer, {} steps", run.steps_done());
    return result;
  };
  request.session.test_views = dataset.test;
  request.session.preview_camera = dataset.train.front().camera;
  if (request.snapshot) request.session.snapshot = [&] { request.snapshot(described()); };
  TrainingSession session(run, std::move(request.session));
  session.run();
  RunResult result{.seconds = session.seconds()};
  const Scene finished = described();
  if (request.finished) session.keep_if_it_fails([&] { request.finished(finished); });
  if (request.snapshot) request.snapshot(finished);
  if (dataset.test.empty()) return result;
  result.test_psnr_db = mean_psnr_db(run, dataset.test, request.measuring);
  if (request.evaluate) request.evaluate(finished);
  return result;
}

}  // namespace tureen::trainer
