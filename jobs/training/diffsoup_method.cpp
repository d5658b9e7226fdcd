#include <fmt/format.h>

#include "base/decimal_text.hpp"
#include "base/error.hpp"
#include "jobs/training/methods.hpp"
#include "trainer/common/plain_background.hpp"
#include "trainer/diffsoup/config_file.hpp"
#include "trainer/diffsoup/texture_level.hpp"
#include "trainer/diffsoup/training.hpp"

namespace tureen {

namespace {

using trainer::Checkpoint;
using trainer::Config;
using trainer::Preset;

class DiffsoupMethod final : public TrainingMethod {
 public:
  explicit DiffsoupMethod(const TrainingOptions& options) : options_(options) {
    trainer::require_device(options.device);
  }

  void resume(const std::filesystem::path& checkpoint) override {
    checkpoint_ = trainer::read_checkpoint(checkpoint);
  }

  void settle(const Dataset* dataset) override {
    if (dataset && !dataset->has_alpha) background_ = trainer::plain_background(*dataset);
    const bool is_place = dataset && !dataset->has_alpha && !background_;
    const bool is_new = !checkpoint_ || options_.name_a_base();
    Config base = is_new ? base_config(options_, is_place ? Preset::scene : Preset::object)
                         : checkpoint_->config;
    if (is_new && background_ && base.preset == Preset::object && options_.file.empty())
      for (int c = 0; c < 3; ++c) base.background[c] = (*background_)[c];
    config_ = with_options(base, options_);
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

  std::string constants() const override { return trainer::config_to_json(config_); }

  TrainingSummary train(Dataset& dataset, const Scene* start, trainer::RunRequest run,
                        const std::function<void(const std::string&)>& say) override {
    const bool preset_by_alpha = !checkpoint_ && !options_.preset && options_.file.empty();
    if (checkpoint_) require_same_views(dataset, checkpoint_->views);
    const int level = trainer::with_fitting_level(config_, dataset).max_level;
    trainer::TrainingResult result = trainer::train(
        dataset,
        {.config = config_,
         .start = start,
         .checkpoint = std::move(checkpoint_),
         .device = options_.device,
         .run = std::move(run),
         .begun = [&](const trainer::Backend& backend, bool visible) {
           if (preset_by_alpha)
             say(dataset.has_alpha ? "The images have alpha: --preset object"
                 : background_     ? "The images have no alpha, but borders of one colour, their "
                                     "background: --preset object"
                                   : "The images have no alpha: --preset scene");
           say(fmt::format("{}; {} to {} with textures of level {}; {}", describe_views(dataset),
                           counted(std::uint64_t(config_.steps), "step"),
                           counted(std::uint64_t(config_.triangles), "triangle"), level,
                           backend.description()));
           if (!visible)
             say("No training image shows a triangle yet: check the cameras of the "
                 "dataset.");
         }});
    return {.run = result.run,
            .primitives = {trainer::PrimitiveKind::triangles, result.state.model.faces()},
            .steps = result.state.step,
            .non_finite = result.state.non_finite,
            .visible_at_start = result.visible_at_start,
            .opacity_binary_fraction = result.opacity_binary_fraction};
  }

 private:
  const TrainingOptions& options_;
  std::optional<Checkpoint> checkpoint_;
  std::optional<glm::vec3> background_;  // of photographs without alpha
  Config config_;
};

}  // namespace

std::unique_ptr<TrainingMethod> make_diffsoup_method(const TrainingOptions& options) {
  return std::make_unique<DiffsoupMethod>(options);
}

}  // namespace tureen
