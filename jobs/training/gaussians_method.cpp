// Training of Gaussians: 3D Gaussian Splatting, and with --flat 2D Gaussian Splatting.
#include "jobs/training/splat_method.hpp"

namespace tureen {

namespace {

using trainer::GaussianConfig;

const MethodOption flat_option{
    .name = "flat",
    .help = "discs (2D Gaussian Splatting) instead of Gaussians with three scales",
    .instead = "triangles are always flat"};

class GaussiansMethod final : public SplatMethod<GaussianConfig, trainer::GaussianParameters> {
 public:
  using SplatMethod::SplatMethod;

 private:
  void set_own(GaussianConfig& config) const override {
    config.flat |= options()[flat_option].flag;
  }
  std::string hint_for(const SplatKernel& kernel) const override {
    const auto* gaussians = std::get_if<Gaussians>(&kernel);
    if (!gaussians || gaussians->flat == config().flat) return random_start;
    return std::string(gaussians->flat ? "--flat trains flat Gaussians; "
                                       : "without --flat, Gaussians have three scales; ") +
           random_start;
  }
};

}  // namespace

const TrainingMethodInfo gaussians_method = splat_method_info<GaussiansMethod, GaussianConfig>(
    "gaussians", "3D Gaussian Splatting, on the CPU", {&flat_option}, trainer::gaussians_magic, 1,
    2000, {{"3dgs", nullptr}, {"2dgs", &flat_option}});

}  // namespace tureen
