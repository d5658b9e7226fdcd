#include "trainer/splats/neural/neural_start.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <variant>

namespace tureen::trainer {

namespace neural_row = splatting::neural_row;

namespace {

/// Semi-axes of the first densities in standard deviations of Gaussians. With photographs of lego
/// at 200x200 that were held back from training, 1.7 and 2 give 27.95 and 27.97 dB.
constexpr float deviations = 2;
/// Their offset over that with the opacity of the Gaussian: transparent densities leave gradients
/// to those behind. With the same photographs, 1 and 0.5 give 27.97 and 28.23 dB; with the present
/// rates, 0.5 and 0.3 give 28.50 and 28.52 dB.
constexpr float offset_share = 0.3f;

}  // namespace

float offset_for(float opacity, float chord) {
  // log1p(-1) has no value.
  return std::min(-std::log1p(-std::min(opacity, 0.999f)) / chord, max_first_offset);
}

void set_first_network(float offset, Random& random, std::size_t i, NeuralParameters& parameters) {
  const double omega = NeuralDensities{}.omega;
  for (std::size_t r = neural_row::frequencies; r < neural_row::amplitudes; ++r)
    parameters.trained(r)[i] = float(omega * random.uniform(-1.0 / 3, 1.0 / 3));
  const double most = std::sqrt(6.0 / double(splatting::neurons)) / omega;
  for (std::size_t r = neural_row::amplitudes; r < neural_row::offset; ++r)
    parameters.trained(r)[i] = float(random.uniform(-most, most));
  parameters.trained(neural_row::offset)[i] = offset;
}

NeuralParameters densities_from(const Splats& splats, int degree, Random& random) {
  const Gaussians& gaussians = std::get<Gaussians>(splats.kernel);
  NeuralDensities densities;
  densities.centers = gaussians.centers;
  for (const glm::vec3& scales : gaussians.scales)
    densities.semi_axes.push_back(deviations * scales);
  densities.rotations = gaussians.rotations;
  densities.networks.resize(NeuralDensities::parameters * gaussians.centers.size());
  NeuralParameters result(
      Splats{.kernel = std::move(densities), .color = splats.color, .profile = splats.profile},
      degree);
  for (std::size_t i = 0; i < result.count(); ++i) {
    // The mean chord of rays through the centre is near that of the ball of the same volume.
    const glm::vec3& s = gaussians.scales[i];
    const double largest = std::max(s.x, std::max(s.y, s.z));
    const double mean = std::cbrt(double(s.x) * double(s.y) * double(s.z));
    const float offset =
        offset_for(gaussians.opacity[i], float(2 * std::max(mean / largest, 1e-3)));
    set_first_network(offset_share * offset, random, i, result);
  }
  return result;
}

}  // namespace tureen::trainer
