// Training of triangle soups: DiffSoup's method.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/decimal_text.hpp"
#include "base/error.hpp"
#include "base/existing_path.hpp"
#include "jobs/training/diffsoup_options.hpp"
#include "jobs/training/first_gaussians.hpp"
#include "jobs/training/methods.hpp"
#include "jobs/training/training_scale.hpp"
#include "trainer/common/plain_background.hpp"
#include "trainer/diffsoup/config_fields.hpp"
#include "trainer/diffsoup/config_file.hpp"
#include "trainer/diffsoup/device.hpp"
#include "trainer/diffsoup/training.hpp"

namespace tureen {

namespace {

using trainer::Checkpoint;
using trainer::Config;
using trainer::Device;
using trainer::Preset;

using Type = MethodOption::Type;

const MethodOption preset_option{
    .name = "preset",
    .type = Type::word,
    .help =
        "constants for the kind of dataset: object (default if the images have alpha, or "
        "borders of one colour) or scene (default otherwise)",
    .instead =
        "this method chooses its constants by the alpha of the photographs; --config changes them",
    .value_name = "NAME",
    .words = {"object", "scene"}};
const MethodOption compat_option{.name = "compat",
                                 .help = "use published DiffSoup's constants where Tureen's differ",
                                 .instead = "--config sets the constants of this method"};
const MethodOption triangles_option{.name = "triangles",
                                    .type = Type::whole,
                                    .help = "number of triangles at the end; 15,000 by default",
                                    .instead = "--max-splats limits the number of splats",
                                    .value_name = "N",
                                    .is_common = true};
const MethodOption batch_option{
    .name = "batch",
    .type = Type::whole,
    .help = "views per step; 4 by default",
    .instead = "a step of this method uses one photograph; --steps sets the number of steps",
    .value_name = "N"};
const MethodOption level_option{
    .name = "level",
    .type = Type::whole,
    .help =
        "finest lattice level: a face has (2^N + 1)(2^N + 2) / 2 texels; by default 3 to 5: "
        "the more pixels a triangle covers, the finer",
    .instead = "splats have no textures; --max-splats sets how much detail they can show",
    .value_name = "N"};
const MethodOption device_option{
    .name = "device",
    .type = Type::word,
    .help = "device for training: auto (default: a GPU if available), cpu or cuda",
    .instead = "this method trains on the CPU, with --device cpu or auto",
    .value_name = "NAME",
    .words = {"auto", "cpu", "cuda"},
    .everywhere = {"auto", "cpu"}};

Device device_of(const TrainingOptions& options) {
  const std::string& word = options[device_option].text;
  return word == "cuda" ? Device::cuda : word == "cpu" ? Device::cpu : Device::automatic;
}

std::optional<Preset> preset_of(const TrainingOptions& options) {
  const std::string& word = options[preset_option].text;
  if (word.empty()) return std::nullopt;
  return word == "object" ? Preset::object : Preset::scene;
}

/// Whether a preset, a file or --compat is given. Single constants then change these instead of the
/// constants of a checkpoint.
bool name_a_base(const TrainingOptions& options) {
  return preset_of(options) || options[compat_option].flag || !options.file.empty();
}

/// The preset, with the file's constants. `otherwise`: the preset if neither names one. Throws
/// InputError for an invalid file, UsageError if it names another preset than --preset.
Config base_config(const TrainingOptions& options, Preset otherwise) {
  const std::optional<Preset> given = preset_of(options);
  const bool published = options[compat_option].flag;
  const Preset kind = given.value_or(otherwise);
  if (options.file.empty()) return published ? trainer::published(kind) : trainer::preset(kind);
  const Config config = constants_of_file(options, [&](const std::filesystem::path& file) {
    return trainer::read_config(open_existing(file), {.preset = kind, .published = published});
  });
  if (given && config.preset != kind)
    throw UsageError("--preset and " + options.file + " name different presets");
  return config;
}

class DiffsoupMethod final : public TrainingMethod {
 public:
  explicit DiffsoupMethod(const TrainingOptions& options)
      : options_(options), device_(device_of(options)) {
    trainer::require_device(device_);
  }

  void resume(const std::filesystem::path& checkpoint) override {
    require_checkpoint_of(diffsoup_method, checkpoint);
    checkpoint_ = trainer::read_checkpoint(open_existing(checkpoint));
  }

  void settle(const Dataset* dataset) override {
    if (dataset && !dataset->has_alpha) background_ = trainer::plain_background(*dataset);
    const bool is_place = dataset && !dataset->has_alpha && !background_;
    const bool is_new = !checkpoint_ || name_a_base(options_);
    Config base = is_new ? base_config(options_, is_place ? Preset::scene : Preset::object)
                         : checkpoint_->config;
    if (is_new && background_ && base.preset == Preset::object && options_.file.empty())
      for (int c = 0; c < 3; ++c) base.background[c] = (*background_)[c];
    config_ = with_options(base, options_);
    replaced_minutes_ = options_.steps ? base.minutes : 0;
    // Without the dataset, a preset that no option names is unknown.
    if (checkpoint_ && (dataset || !is_new))
      if (const auto reason = difference(config_, checkpoint_->config))
        throw UsageError("--resume needs the configuration of the checkpoint: " + *reason);
    if (!checkpoint_) require_scene(config_.initialisation, options_);
  }

  std::optional<UnsuitableStart> unsuitable(const Scene& start) const override {
    const auto* splats = std::get_if<Splats>(&only_layer(start).primitives);
    // Triangle windows become opaque triangles; Gaussians give places and normals.
    if (!splats || std::holds_alternative<TriangleWindows>(splats->kernel) ||
        std::holds_alternative<Gaussians>(splats->kernel))
      return std::nullopt;
    return UnsuitableStart{
        fmt::format("the scene has {} ({}), but soups begin with triangles or Gaussians",
                    counted(splat_count(start), "splat"), kernel_name(splats->kernel)),
        "--init random needs no scene"};
  }

  double minutes() const override { return config_.minutes; }

  std::string constants() const override { return trainer::config_to_json(config_); }

  TrainingSummary train(Dataset& dataset, const Scene* start, trainer::RunRequest run,
                        const std::function<void(const RunPlan&)>& begun) override {
    if (checkpoint_) require_same_views(dataset, checkpoint_->views);
    RunPlan plan = plan_for(dataset);
    plan.steps = config_.steps;
    plan.minutes = config_.minutes;
    plan.last = std::uint64_t(config_.triangles);
    if (!checkpoint_ && !preset_of(options_) && options_.file.empty())
      plan.notes.push_back(preset_note(dataset));
    if (replaced_minutes_ > 0) plan.notes.push_back(replaced_minutes(replaced_minutes_));
    const auto preparing = run.preparing;
    const int threads = run.threads;
    trainer::TrainingRequest request{.config = config_,
                                     .start = start,
                                     .checkpoint = std::move(checkpoint_),
                                     .device = device_,
                                     .run = std::move(run)};
    request.first_scene = [&](Config settled, Region region) -> std::optional<Scene> {
      if (!begins_with_gaussians(settled, dataset)) return std::nullopt;
      const double scale = training_scale(dataset);
      scale_dataset(dataset, scale);
      settled.box *= float(scale);
      region = {region.center * scale, region.half_side * scale};
      Scene gaussians = first_gaussians(dataset, settled, region, threads, preparing);
      scale_dataset(dataset, 1 / scale);
      return scaled_scene(std::move(gaussians), 1 / scale);
    };
    request.begun = [&](const trainer::SoupStart& made) {
      plan.first = made.triangles;
      plan.details.push_back({"level", double(made.settled.max_level),
                              fmt::format("textures of level {}", made.settled.max_level)});
      plan.settled = trainer::config_to_json(made.settled);
      plan.device = made.backend.description();
      if (!made.is_visible)
        plan.notes.push_back(
            {"nothing_visible", true,
             "No training image shows a triangle yet: check the cameras of the dataset."});
      begun(plan);
    };
    trainer::TrainingResult result = trainer::train(dataset, std::move(request));
    return {.run = result.run,
            .primitives = {trainer::PrimitiveKind::triangles, result.state.model.faces()},
            .steps = result.state.step,
            .non_finite = result.state.non_finite,
            .own = {{"visible_at_start", result.visible_at_start},
                    {"opacity_binary_fraction", result.opacity_binary_fraction,
                     fmt::format("{:.1f} % of the texels are transparent or opaque",
                                 100 * result.opacity_binary_fraction)}}};
  }

 private:
  OwnFact preset_note(const Dataset& dataset) const {
    return {"preset", std::string(config_.preset == Preset::object ? "object" : "scene"),
            dataset.has_alpha ? "Using preset object, because the images have alpha"
            : background_     ? "The images have no alpha, but borders of one colour, their "
                                "background: --preset object"
                              : "The images have no alpha: --preset scene"};
  }

  const TrainingOptions& options_;
  Device device_;
  std::optional<Checkpoint> checkpoint_;
  std::optional<glm::vec3> background_;  // of photographs without alpha
  Config config_;
  double replaced_minutes_ = 0;  // of a file, by --steps; 0: none
};

}  // namespace

const MethodOption export_option{
    .name = "export-diffsoup",
    .type = Type::path,
    .help = "also write a folder for DiffSoup's web viewer",
    .instead = "Tureen's own page shows scenes of every method: tureen convert OUT.glb page.html",
    .value_name = "FOLDER"};

const TrainingMethodInfo diffsoup_method{
    .name = "diffsoup",
    .summary = "opaque triangles with textures",
    .options = {&minutes_option, &preset_option, &compat_option, &triangles_option, &batch_option,
                &level_option, &device_option, &export_option},
    .aliases = {},
    .constants = [] { return names_of_fields(trainer::config_fields()); },
    .reference = &trainer::config_reference,
    .magic = trainer::diffsoup_magic,
    .cost_of_pixel = 4,  // four photographs a step
    .least_steps = 2000,
    .make = [](const TrainingOptions& options) -> std::unique_ptr<TrainingMethod> {
      return std::make_unique<DiffsoupMethod>(options);
    }};

Config with_options(const Config& base, const TrainingOptions& options) {
  const auto fields = trainer::config_fields();
  Config config = base;
  if (const auto& triangles = options[triangles_option].whole) {
    const double ratio = double(*triangles) / config.triangles;
    config.initial_triangles =
        int(std::clamp(std::round(config.initial_triangles * ratio), 1.0, 4e6));
    set_whole(config.triangles, triangles, "triangles", fields);
  }
  set_whole(config.steps, options.steps, "steps", fields);
  set_time(config.minutes, options);
  set_whole(config.batch, options[batch_option].whole, "batch", fields);
  config.seed = options.seed.value_or(config.seed);
  if (const auto& level = options[level_option].whole) {
    set_whole(config.max_level, level, "max_level", fields);
    if (config.max_level != trainer::automatic_level) {
      config.min_level = std::min(config.min_level, config.max_level);
      config.coarse_level = std::min(config.coarse_level, config.min_level);
    }
  }
  set_initialisation(config.initialisation, options);
  if (const std::optional<std::string> reason = trainer::defect(config)) throw UsageError(*reason);
  return config;
}

}  // namespace tureen
