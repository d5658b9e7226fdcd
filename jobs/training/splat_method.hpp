// Training of splats: what its methods share.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "base/decimal_text.hpp"
#include "base/error.hpp"
#include "base/existing_path.hpp"
#include "base/memory_budget.hpp"
#include "base/platform/scratch_file.hpp"
#include "jobs/training/methods.hpp"
#include "jobs/training/training_scale.hpp"
#include "trainer/common/plain_background.hpp"
#include "trainer/splats/splat_forecast.hpp"
#include "trainer/splats/splat_start.hpp"
#include "trainer/splats/splat_training.hpp"

namespace tureen {

inline const MethodOption max_splats_option{
    .name = "max-splats",
    .type = MethodOption::Type::whole,
    .help =
        "largest number of splats; by default 60,000 Gaussians or soft triangles, or 10,000 neural "
        "densities",
    .instead = "--triangles sets the number of triangles",
    .value_name = "N",
    .is_common = true};
inline const MethodOption max_bytes_option{
    .name = "max-bytes",
    .type = MethodOption::Type::whole,
    .help =
        "instead of a number of splats: largest number of bytes of all splats, as 32-bit floats; "
        "also chooses the degree of their harmonics",
    .instead = "--triangles and --level set the size of a soup",
    .value_name = "N"};

/// Bytes of a splat's values as single floats, as files without compression store them.
template <class Parameters>
std::size_t bytes_of_splat(int degree) {
  return sizeof(float) * Parameters(0, degree).rows();
}

struct SplatsInBytes {
  int degree = 0;
  std::uint64_t splats = 0;
};

/// The highest degree with which at least Parameters::least_of_degree splats fit in `bytes`, and
/// that number of splats; 0 splats: not even one fits. Few splats gain more by their number than by
/// colours that depend on the direction.
template <class Parameters>
SplatsInBytes splats_in_bytes(std::uint64_t bytes) {
  for (int degree = int(Parameters::least_of_degree.size()) - 1; degree > 0; --degree)
    if (const std::uint64_t splats = bytes / bytes_of_splat<Parameters>(degree);
        splats >= Parameters::least_of_degree[std::size_t(degree)])
      return {degree, splats};
  return {0, bytes / bytes_of_splat<Parameters>(0)};
}

/// A run on a dataset that was scaled: its callbacks receive scenes in the units of the world, and
/// the evaluation finds the dataset in them.
inline trainer::RunRequest in_world_units(trainer::RunRequest run, Dataset& dataset, double scale) {
  const auto scaled_back = [scale](const std::function<void(const Scene&)>& act) {
    if (!act) return act;
    return std::function<void(const Scene&)>(
        [=](const Scene& scene) { act(scaled_scene(scene, 1 / scale)); });
  };
  run.snapshot = scaled_back(run.snapshot);
  run.finished = scaled_back(run.finished);
  if (run.evaluate)
    run.evaluate = [=, &dataset, evaluate = scaled_back(run.evaluate)](const Scene& scene) {
      scale_dataset(dataset, 1 / scale);
      evaluate(scene);
      scale_dataset(dataset, scale);
    };
  return run;
}

template <class Config, class Parameters>
class SplatMethod : public TrainingMethod {
 public:
  using Checkpoint = trainer::SplatCheckpoint<Config, Parameters>;

  explicit SplatMethod(const TrainingOptions& options) : options_(options) {}

  void resume(const std::filesystem::path& checkpoint) override {
    require_checkpoint_of(*options_.method, checkpoint);
    checkpoint_ = trainer::read_splat_checkpoint<Checkpoint>(open_existing(checkpoint));
  }

  void settle(const Dataset* dataset) override {
    Config base;
    // Photographs of a scene have no background: a pixel without a splat is an error. With a white
    // background it would match white walls.
    if (dataset && !dataset->has_alpha) {
      const auto plain = trainer::plain_background(*dataset);
      const glm::vec3 background = plain.value_or(glm::vec3(0));
      for (int c = 0; c < 3; ++c) base.background[c] = background[c];
      if (!plain) base.far_splats = 0.5;
    }
    if (!options_.file.empty())
      base = constants_of_file(options_, [&](const std::filesystem::path& file) {
        return trainer::read_splat_config(open_existing(file), base);
      });
    else if (checkpoint_)
      base = checkpoint_->config;
    config_ = with_options(base);
    replaced_minutes_ = options_.steps ? base.minutes : 0;
    if (dataset) limit_memory(*dataset);
    // --max-memory lowered the number of this run; its limit may depend on the version of Tureen.
    if (checkpoint_ && options_.max_memory)
      config_.max_splats = std::min(config_.max_splats, checkpoint_->config.max_splats);
    // Without the dataset, the background of a file that does not name it is unknown.
    if (checkpoint_ && (dataset || options_.file.empty()))
      if (const auto reason = splat_config_difference(config_, checkpoint_->config))
        throw UsageError("--resume needs the configuration of the checkpoint: " + *reason);
    if (!checkpoint_) require_scene(config_.initialisation, options_);
  }

  std::optional<UnsuitableStart> unsuitable(const Scene& start) const override {
    const auto* splats = std::get_if<Splats>(&only_layer(start).primitives);
    if (!splats || trainer::can_begin_with(*splats, config_)) return std::nullopt;
    return UnsuitableStart{
        fmt::format("the scene has {} ({}), but {} begin with {} or triangles",
                    counted(splat_count(start), "splat"), kernel_name(splats->kernel),
                    trainer::kernel_of(config_), trainer::starts_of(config_)),
        hint_for(splats->kernel)};
  }

  double minutes() const override { return config_.minutes; }

  std::string constants() const override { return trainer::splat_config_to_json(config_); }

  TrainingSummary train(Dataset& dataset, const Scene* start, trainer::RunRequest run,
                        const std::function<void(const RunPlan&)>& begun) override {
    const double scale = training_scale(dataset);
    std::optional<Scene> scaled_start;
    if (scale != 1) {
      scale_dataset(dataset, scale);
      if (start) start = &scaled_start.emplace(scaled_scene(*start, scale));
      run = in_world_units(std::move(run), dataset, scale);
    }
    if (moves_photographs_) {
      const auto file = std::make_shared<ScratchFile>();
      for (auto* views : {&dataset.train, &dataset.test})
        for (Photograph& view : *views) view.move_to(file);
    }
    if (checkpoint_) require_same_views(dataset, checkpoint_->views);
    RunPlan plan = plan_for(dataset);
    if (scale != 1)
      plan.notes.push_back(
          {"scale", scale,
           fmt::format(
               "The cameras are {} what they show: it is trained at {:g} times its size, and "
               "scaled back",
               scale > 1 ? "nearer than usual to" : "farther than usual from", scale)});
    plan.steps = config_.steps;
    plan.minutes = config_.minutes;
    plan.kind = trainer::PrimitiveKind::splats;
    plan.last = config_.max_splats;
    plan.bytes = trainer::splat_memory(config_, dataset);
    if (is_limited_)
      plan.notes.push_back({"max_memory", double(config_.max_splats),
                            "--max-memory allows at most " + counted(config_.max_splats, "splat")});
    if (const auto& bytes = options_[max_bytes_option].whole)
      plan.notes.push_back(
          {"max_bytes", double(*bytes),
           fmt::format("--max-bytes {} allows {} with harmonics of degree {}, of {} bytes each",
                       *bytes, counted(config_.max_splats, "splat"), config_.degree,
                       bytes_of_splat<Parameters>(config_.degree))});
    if (replaced_minutes_ > 0) plan.notes.push_back(replaced_minutes(replaced_minutes_));
    trainer::SplatRequest<Config, Parameters> request{.config = config_,
                                                      .start = start,
                                                      .checkpoint = std::move(checkpoint_),
                                                      .run = std::move(run)};
    request.first_scene = [&, threads = request.run.threads,
                           preparing = request.run.preparing](const Region& region) {
      return first_scene(dataset, region, threads, preparing);
    };
    request.begun = [&](const trainer::SplatStart& made) {
      plan.first = made.splats;
      plan.device = "CPU, " + counted(std::uint64_t(made.threads), "thread");
      begun(plan);
    };
    const trainer::SplatResult result = trainer::train_splats(dataset, std::move(request));
    return {.run = result.run,
            .primitives = result.primitives,
            .steps = result.steps,
            .non_finite = result.non_finite};
  }

 protected:
  /// Sets the constants of options that only this method has.
  virtual void set_own(Config& config) const = 0;
  /// SplatRequest::first_scene. `preparing`: as RunRequest's.
  virtual std::optional<Scene> first_scene(const Dataset&, const Region&, int,
                                           const std::function<void(double)>&) const {
    return std::nullopt;
  }
  /// The hint of unsuitable().
  virtual std::string hint_for(const SplatKernel&) const { return random_start; }

  static constexpr const char* random_start = "--init random needs no scene";

  const Config& config() const { return config_; }
  const TrainingOptions& options() const { return options_; }

 private:
  /// `config` with the single constants. --steps sets minutes to 0.
  Config with_options(Config config) const {
    const auto fields = trainer::splat_config_fields<Config>();
    set_own(config);
    set_whole(config.steps, options_.steps, "steps", fields);
    set_whole(config.max_splats, options_[max_splats_option].whole, "max_splats", fields);
    if (const auto& bytes = options_[max_bytes_option].whole) set_bytes(config, *bytes);
    set_time(config.minutes, options_);
    config.seed = options_.seed.value_or(config.seed);
    set_initialisation(config.initialisation, options_);
    if (const std::optional<std::string> reason = trainer::splat_config_defect(config))
      throw UsageError(*reason);
    return config;
  }

  /// The number of splats and their degree by --max-bytes.
  void set_bytes(Config& config, std::int64_t bytes) const {
    if (options_[max_splats_option].whole)
      throw UsageError("--max-splats and --max-bytes exclude each other",
                       "--max-bytes chooses the number of splats");
    const auto fitting =
        splats_in_bytes<Parameters>(std::uint64_t(std::max<std::int64_t>(bytes, 0)));
    if (fitting.splats == 0)
      throw UsageError(fmt::format("--max-bytes: {} is out of range; one splat has {} bytes", bytes,
                                   bytes_of_splat<Parameters>(0)));
    config.degree = fitting.degree;
    config.max_splats = fitting.splats;
  }

  /// Moves the photographs to a file, then lowers max_splats, so that the run fits in --max-memory.
  void limit_memory(const Dataset& dataset) {
    if (!options_.max_memory) return;
    using trainer::PhotographPlace;
    // Photographs leave the memory before the scene gets fewer splats.
    moves_photographs_ = trainer::splat_memory(config_, dataset) > *options_.max_memory;
    if (checkpoint_) return;
    const auto fitting = trainer::max_splats_within(
        *options_.max_memory, config_, dataset,
        moves_photographs_ ? PhotographPlace::in_file : PhotographPlace::as_now);
    if (!fitting)
      throw UsageError("--max-memory " + memory_size_text(*options_.max_memory) +
                           " is too little for these photographs and 1,000 splats",
                       "--scale makes the photographs smaller");
    is_limited_ = *fitting < config_.max_splats;
    config_.max_splats = *fitting;
  }

  const TrainingOptions& options_;
  std::optional<Checkpoint> checkpoint_;
  Config config_;
  bool is_limited_ = false, moves_photographs_ = false;
  double replaced_minutes_ = 0;  // of a file, by --steps; 0: none
};

/// The info of a method of splats. `own`: its own options. `Method`: a SplatMethod.
template <class Method, class Config>
TrainingMethodInfo splat_method_info(const char* name, const char* summary,
                                     std::vector<const MethodOption*> own,
                                     trainer::CheckpointMagic magic, double cost_of_pixel,
                                     int least_steps,
                                     decltype(TrainingMethodInfo::aliases) aliases = {}) {
  own.insert(own.begin(), {&minutes_option, &max_splats_option, &max_bytes_option});
  return {.name = name,
          .summary = summary,
          .options = std::move(own),
          .aliases = std::move(aliases),
          .constants = [] { return names_of_fields(trainer::splat_config_fields<Config>()); },
          .reference = &trainer::splat_config_reference<Config>,
          .magic = magic,
          .cost_of_pixel = cost_of_pixel,
          .least_steps = least_steps,
          .make = [](const TrainingOptions& options) -> std::unique_ptr<TrainingMethod> {
            return std::make_unique<Method>(options);
          }};
}

}  // namespace tureen
