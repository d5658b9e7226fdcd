#include "jobs/tradeoff/measurer.hpp"

#include <algorithm>
#include <future>
#include <thread>
#include <tuple>

#include "base/error.hpp"
#include "jobs/baseline/baseline.hpp"
#include "jobs/timing/benchmark.hpp"
#include "jobs/tradeoff/references.hpp"

namespace tureen::tradeoff {

namespace {

FrameStatistics scaled(FrameStatistics ms, double factor) {
  for (double* value : {&ms.mean, &ms.median, &ms.p95, &ms.p99, &ms.min_of_medians})
    *value *= factor;
  ms.low_1_percent_fps /= factor;
  return ms;
}

/// The errors against both references; FLIP only against the judge.
using Errors = std::pair<RenderError, std::optional<ExactError>>;

Errors errors_of(const References& references, std::span<const ImageF> drawn, bool with_flip) {
  Errors errors{error_between(references.judge, drawn, with_flip), std::nullopt};
  if (!references.exact.empty()) {
    const RenderError exact = error_between(references.exact, drawn, false);
    errors.second = ExactError{exact.psnr_db, exact.coverage_mismatch};
  }
  return errors;
}

}  // namespace

Job job_of(const std::vector<QualitySetting>& settings, const Configuration& configuration,
           bool specialised) {
  Job job;
  job.outcome.configuration = configuration;
  job.outcome.name = describe(settings, configuration);
  job.outcome.applied = applied_by(settings, configuration);
  job.outcome.factor = specialised ? Factor::specialised : Factor::generic;
  job.plan.specialise = specialised;
  job.plan.quality = job.outcome.applied.quality;
  return job;
}

void Measurer::measure(std::vector<Job> jobs, const char* stage) {
  for (std::size_t begin = 0; begin < jobs.size();) {
    const std::size_t room = options_.group - (control_ ? 1 : 0);
    const std::size_t end = std::min(begin + std::max<std::size_t>(room, 1), jobs.size());
    share_ = {double(begin) / double(jobs.size()), double(end - begin) / double(jobs.size())};
    stage_ = stage;
    measure_group({jobs.begin() + std::ptrdiff_t(begin), jobs.begin() + std::ptrdiff_t(end)});
    begin = end;
  }
}

void Measurer::report_share(double fraction) const {
  options_.report(stage_, share_.first + share_.second * fraction);
}

std::unique_ptr<Renderer> Measurer::renderer_for(const Job& job) const {
  const RenderOptions options{.plan = job.plan, .background = {options_.background, 0.0f}};
  const PipelineKind pipeline =
      job.outcome.factor == Factor::baseline ? PipelineKind::baseline : PipelineKind::tureen;
  const auto renderer_of = [&](const Scene& scene) {
    return std::make_unique<Renderer>(make_renderer(scene_.context, scene, pipeline, options));
  };
  const Applied& applied = job.outcome.applied;
  if (!has_edits(applied)) return renderer_of(scene_.scene);
  return renderer_of(edited(scene_.scene, applied, [this](double) { report_share(0.2 * made_); }));
}

void Measurer::measure_group(std::vector<Job> jobs) {
  std::vector<Running> running;
  if (control_) running.push_back({*control_, renderer_for(*control_)});
  for (Job& job : jobs) {
    made_ = double(running.size()) / double(jobs.size() + 1);
    report_share(0.2 * made_);
    try {
      std::unique_ptr<Renderer> renderer = renderer_for(job);
      renderer->draw({scene_.cameras.front()});
      running.push_back({std::move(job), std::move(renderer)});
    } catch (const Error& error) {
      // The defaults must be drawable. Other configurations that are not supported are skipped.
      const bool refused =
          dynamic_cast<const UsageError*>(&error) || dynamic_cast<const DeviceLimitError*>(&error);
      if (!control_ && running.empty()) throw;
      if (!refused) throw;
      panel_.skipped.push_back({job.outcome.name, error.reason()});
    }
  }
  if (running.size() > (control_ ? 1u : 0u)) time_and_compare(running);
}

void Measurer::time_and_compare(std::vector<Running>& running) {
  std::vector<BenchmarkCase> cases;
  for (const Running& each : running)
    cases.push_back(
        {each.job.outcome.name,
         [renderer = each.renderer.get()](const FrameInput& input) { renderer->draw(input); },
         [renderer = each.renderer.get()] { renderer->finish(); }});
  const BenchmarkResult result =
      run_benchmark(cases, scene_.cameras,
                    {.rounds = options_.rounds,
                     .min_sample_ms = scene_.context.capabilities().software ? 0.0 : 5.0,
                     .progress = [&](double fraction) { report_share(0.2 + 0.6 * fraction); },
                     .clock = options_.clock});
  panel_.aa_spread = std::max(panel_.aa_spread, result.aa_spread);

  const FrameStatistics control = statistics_of(result.cases[0].times);
  if (!control_) control_ms_ = control.min_of_medians;
  const double factor = control_ms_ / control.min_of_medians;
  const std::size_t first = control_ ? 1 : 0;
  for (std::size_t i = first; i < running.size(); ++i) {
    Outcome& outcome = running[i].job.outcome;
    outcome.ms = scaled(statistics_of(result.cases[i].times), factor);
    const Renderer& renderer = *running[i].renderer;
    outcome.device_mib = double(renderer.device_bytes() + renderer.target_bytes()) / (1 << 20);
    outcome.stable = result.cases[i].stable;
  }
  compare(running, first);
  if (!control_) control_ = running.front().job;
  for (std::size_t i = first; i < running.size(); ++i)
    panel_.outcomes.push_back(std::move(running[i].job.outcome));
}

/// Draws the frames again after timing and computes their errors, with one configuration per core.
void Measurer::compare(std::vector<Running>& running, std::size_t first) {
  const std::size_t most = std::max(1u, std::thread::hardware_concurrency());
  std::vector<std::future<Errors>> errors;
  const auto take = [&](std::size_t i) {
    Outcome& outcome = running[first + i].job.outcome;
    std::tie(outcome.error, outcome.exact) = errors[i].get();
  };
  for (std::size_t i = first; i < running.size(); ++i) {
    report_share(0.8 + 0.2 * double(i) / double(running.size()));
    std::vector<Image8> drawn;
    for (const Camera& camera : scene_.cameras) {
      running[i].renderer->draw({camera});
      drawn.push_back(running[i].renderer->read_color());
    }
    if (errors.size() >= most) take(errors.size() - most);
    errors.push_back(std::async(std::launch::async, [this, drawn = std::move(drawn)] {
      std::vector<ImageF> images;
      for (const Image8& image : drawn)
        images.push_back(composited(to_float(image), options_.background));
      // A partly covered pixel has a colour and a coverage. A screen shows the mixture with the
      // background in 8 bits.
      images = as_shown(images);
      return errors_of(references_, images, options_.with_flip);
    }));
  }
  for (std::size_t i = 0; i < errors.size(); ++i)
    if (errors[i].valid()) take(i);
}

}  // namespace tureen::tradeoff
