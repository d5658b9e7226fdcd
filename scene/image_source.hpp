// Whatever draws a scene from a camera: the runtime, the oracle, tiles, a model in training.
#pragma once

#include <optional>

#include "image/image.hpp"
#include "scene/frame_input.hpp"

namespace tureen {

class ImageSource {
 public:
  virtual ~ImageSource() = default;

  /// The camera's image with 8 bits per channel: display-referred colours over the background of
  /// the source; alpha is the coverage, or 1 if the source does not know it. Throws the errors of
  /// the source.
  virtual Image8 image(const FrameInput& input) = 0;
  /// The image before rounding to bytes; nullopt if the source has only bytes.
  virtual std::optional<ImageF> exact_image(const FrameInput&) { return std::nullopt; }
};

}  // namespace tureen
