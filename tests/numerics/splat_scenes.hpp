// Splats for tests of numerics, and their alpha on the device and in the oracle.
#pragma once

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <utility>
#include <vector>

#include "oracle/oracle.hpp"
#include "runtime/renderer.hpp"
#include "scene/splats.hpp"
#include "tests/numerics/recorder.hpp"
#include "tests/numerics/scenes.hpp"

namespace tureen::test {

/// White splats with this kernel.
inline Splats white_splats(SplatKernel kernel, const SplatProfile& profile) {
  Splats splats{.kernel = std::move(kernel), .profile = profile};
  splats.color.coefficients.assign(count(splats), glm::vec3(0.5f / 0.28209479f));
  return splats;
}

/// The blended splats: premultiplied RGBA, row 0 on top. Rasterised in 32-bit floats, unless the
/// options say otherwise: the steps of coarser formats would hide what is measured.
inline std::vector<glm::vec4> blended_by_device(const Scene& scene, const Camera& camera,
                                                RenderOptions options = {}) {
  if (options.plan.splat_blending == SplatBlending::automatic)
    options.plan.splat_blending = SplatBlending::raster;
  if (options.splat_format == SplatFormat::automatic) options.splat_format = SplatFormat::rgba32f;
  gl::Context& context = shared_context();
  Renderer renderer(context, prepare_scene(scene, device_limits(context.capabilities()), options),
                    options);
  renderer.draw({camera});
  return renderer.read_splats();
}

/// One minus the transmittance at each pixel, of all splats.
inline std::vector<double> alpha_of_oracle(const Scene& scene, const Camera& camera) {
  OracleOptions options;
  options.splat_stop = false;
  return render_oracle(scene, {camera}, options).splat_alpha;
}

/// The largest difference of the device's alpha from these.
inline double alpha_error(const Scene& scene, const Camera& camera,
                          const std::vector<double>& expected) {
  const std::vector<glm::vec4> blended = blended_by_device(scene, camera);
  double error = blended.size() == expected.size() ? 0 : NAN;
  for (std::size_t i = 0; i < blended.size(); ++i)
    error = worse(error, std::abs(double(blended[i].a) - expected[i]));
  return error;
}

/// The direction of straight_camera()'s ray through the centre of a pixel, with a depth of 1.
inline glm::dvec3 ray_of_pixel(const Camera& camera, int x, int y) {
  return {(x + 0.5 - camera.cx) / camera.fx, (camera.cy - y - 0.5) / camera.fy, -1};
}

}  // namespace tureen::test
