// What the images of one scene may hold together. One image is bounded by max_image_pixels, but a
// megabyte of PNG can unfold to a gigabyte, and a scene may name a thousand of them.
#pragma once

#include <cstddef>

#include "soup/image.hpp"

namespace tureen {

class ImageBudget {
 public:
  /// 4 GiB of RGBA8: twice what the largest published MobileNeRF scenes (16 shapes, two images of
  /// 4096 x 4096 each) take.
  static constexpr std::size_t max_pixels = std::size_t(1) << 30;

  /// Counts an image that has been decoded; false where it is one too many.
  bool take(const Image8& image) {
    taken_ += image.pixels.size();
    return taken_ <= max_pixels;
  }

 private:
  std::size_t taken_ = 0;
};

inline constexpr char image_budget_reason[] = "the images of this scene are too large: over 4 GiB";

}  // namespace tureen
