// The arithmetic of a training step, on the processor (cpu/) or a GPU (cuda/).
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "scene/camera.hpp"
#include "trainer/common/trainable.hpp"
#include "trainer/common/training_views.hpp"
#include "trainer/diffsoup/config.hpp"
#include "trainer/diffsoup/state.hpp"

namespace tureen::trainer {

/// Learning rates of one step, after decay.
struct Rates {
  float texture, mlp, vertex;
};

/// Wall time of each stage in seconds, and the amount of work. On the processor, the backward pass
/// of shading includes the gradient of edges. Both are sums over the steps since the last
/// take_times().
struct StageTimes {
  double visibility = 0, shading = 0, loss = 0, shading_backward = 0, faces = 0;
  std::uint64_t fragments = 0;  // pixel centres of triangles whose depth was compared
  std::uint64_t shaded_pixels = 0, pixels = 0, steps = 0;
};

/// How fragments are accepted: stochastic in training steps, threshold for images.
enum class Masking { threshold, stochastic };

class Backend {
 public:
  virtual ~Backend() = default;

  /// "CPU, 2 threads", "NVIDIA ..".
  virtual std::string description() const = 0;

  /// Replaces the state; the views stay those of the constructor.
  virtual void upload(const TrainingState& state) = 0;
  /// Copies the current state.
  virtual void download(TrainingState& state) const = 0;

  /// One step of the optimiser on the named views; its images have stochastic masking.
  virtual StepReport step(std::span<const std::uint32_t> views, const Rates& rates) = 0;

  virtual StageTimes take_times() = 0;

  /// Visible pixels of each face, summed over all `cameras`, with threshold masking.
  virtual std::vector<std::uint64_t> visible_pixels(std::span<const Camera> cameras) = 0;

  /// The image with threshold masking: three planes of floats in [0, 1].
  virtual std::vector<float> render(const Camera& camera) = 0;
};

/// `threads`: number of threads, 0 for all cores. The views must outlive the backend.
std::unique_ptr<Backend> make_cpu_backend(std::span<const TrainingView> views, const Config& config,
                                          int threads);

}  // namespace tureen::trainer
