// An image that is in memory, or in a file and read when it is needed. Copies share its pixels.
#pragma once

#include <memory>
#include <utility>

#include "base/platform/stored_bytes.hpp"
#include "image/image.hpp"

namespace tureen {

class StoredImage {
 public:
  StoredImage() = default;
  StoredImage(Image8 image)
      : width_(image.width),
        height_(image.height),
        image_(std::make_shared<const Image8>(std::move(image))) {}

  int width() const { return width_; }
  int height() const { return height_; }
  std::size_t pixels() const { return std::size_t(width_) * std::size_t(height_); }
  /// Whether all alpha is 255.
  bool is_opaque() const;

  /// A copy of the image, read from the file if it is there. Throws InputError if the file cannot
  /// be read.
  Image8 operator()() const;

  /// Moves the pixels to the file, unless they are in one. Throws OutputError if the disk is full.
  void move_to(const std::shared_ptr<ScratchFile>& file);
  /// Sets all alpha to 255. In the file this writes nothing: the plane of alpha is the last.
  void remove_alpha();
  /// In the file: planes of width x height bytes, row 0 on top: red, green, blue and, unless the
  /// image is opaque, alpha. Empty for an image in memory.
  const StoredBytes& planes() const { return planes_; }

 private:
  int width_ = 0, height_ = 0;
  std::shared_ptr<const Image8> image_;  // null: in the file
  StoredBytes planes_;
};

}  // namespace tureen
