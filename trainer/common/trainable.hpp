// A model in training, as a session sees it. Each method of training implements it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <vector>

#include "scene/camera.hpp"
#include "scene/image_source.hpp"
#include "trainer/common/primitive_count.hpp"

namespace tureen::trainer {

struct StepReport {
  double loss = 0;  // mean over the batch, the differentiated loss
  double l1 = 0;
  double ssim = 0;
  double mse = 0;                // of the step's images
  std::uint64_t non_finite = 0;  // pixels and parameters quarantined in this step
};

class Trainable : public ImageSource {
 public:
  /// Steps of the whole run. It may change between two steps.
  virtual int steps() const = 0;
  virtual int steps_done() const = 0;
  /// The work of the next step and of all remaining steps, in the same unit: a forecast of the time
  /// that is left is the time per work so far, times work_left().
  virtual double work_of_step() const { return 1; }
  virtual double work_left() const { return steps() - steps_done(); }
  /// The number of steps with which work_left() takes `seconds`, if one unit of work takes
  /// `seconds_per_work`.
  virtual int steps_in(double seconds, double seconds_per_work) const;
  /// Sets steps(), at least steps_done(), for the schedule from the next step on.
  virtual void set_steps(int steps) = 0;
  virtual StepReport step() = 0;
  virtual PrimitiveCount primitives() const = 0;

  /// The image that a viewer would show: three planes of floats, row 0 on top.
  virtual std::vector<float> render(const Camera& camera) = 0;
  /// That image, opaque.
  Image8 image(const FrameInput& input) final { return quantised(*exact_image(input)); }
  std::optional<ImageF> exact_image(const FrameInput& input) final;
  /// Red, green, blue in [0, 1]; behind the photographs, too.
  virtual std::span<const float, 3> background() const = 0;

  /// Writes the complete state or no file. `seconds`: training time so far. Throws OutputError.
  virtual void write_checkpoint(const std::filesystem::path& path, double seconds) const = 0;
};

}  // namespace tureen::trainer
