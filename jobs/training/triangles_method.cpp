// Training of soft triangles, Triangle Splatting, which may become opaque.
#include "jobs/training/splat_method.hpp"

namespace tureen {

namespace {

using trainer::WindowConfig;

const MethodOption opaque_option{
    .name = "opaque",
    .help = "triangles become opaque at the end; the result is a triangle soup",
    .instead = "--method triangles can end with opaque triangles; those of a soup always are"};

class TrianglesMethod final : public SplatMethod<WindowConfig, trainer::WindowParameters> {
 public:
  using SplatMethod::SplatMethod;

 private:
  void set_own(WindowConfig& config) const override {
    config.opaque |= options()[opaque_option].flag;
  }
};

}  // namespace

const TrainingMethodInfo triangles_method = splat_method_info<TrianglesMethod, WindowConfig>(
    "triangles", "Triangle Splatting, on the CPU", {&opaque_option}, trainer::triangles_magic, 1.5,
    2000);

}  // namespace tureen
