// Training of neural densities: Splat the Net. Gaussians are trained first, if nothing says where
// to begin.
#include "jobs/training/first_gaussians.hpp"
#include "jobs/training/splat_method.hpp"

namespace tureen {

namespace {

using trainer::GaussianConfig;
using trainer::NeuralConfig;

class NeuralMethod final : public SplatMethod<NeuralConfig, trainer::NeuralParameters> {
 public:
  using SplatMethod::SplatMethod;

 private:
  void set_own(NeuralConfig&) const override {}

  std::optional<Scene> first_scene(const Dataset& dataset, const Region& region, int threads,
                                   const std::function<void(double)>& preparing) const override {
    const NeuralConfig& own = config();
    if (own.initialisation != trainer::Initialisation::automatic || own.gaussian_steps == 0)
      return std::nullopt;
    FirstGaussians first;
    first.seconds = 60 * own.minutes * own.gaussian_share;
    GaussianConfig& constants = first.constants;
    // A training that takes longer than that of the densities would take the place of it.
    constants.steps =
        own.minutes > 0 ? own.gaussian_steps : std::min(own.gaussian_steps, own.steps);
    constants.max_splats = own.max_splats;
    constants.first_splats = std::min(constants.first_splats, own.max_splats);
    constants.degree = own.degree;
    constants.seed = own.seed;
    std::ranges::copy(own.background, constants.background);
    constants.far_splats = own.far_splats;
    constants.far_extent = own.far_extent;
    Scene scene = train_first_gaussians(dataset, first, region, threads, preparing);
    // Without a Gaussian that a viewer can draw, the densities begin as if there were none.
    if (splat_count(scene) == 0) return std::nullopt;
    return scene;
  }
};

}  // namespace

const TrainingMethodInfo neural_method = splat_method_info<NeuralMethod, NeuralConfig>(
    "neural", "splattable neural primitives, on the CPU", {}, trainer::neural_magic, 3, 2000);

}  // namespace tureen
