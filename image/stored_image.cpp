#include "image/stored_image.hpp"

#include <algorithm>

namespace tureen {

bool StoredImage::is_opaque() const {
  if (!image_) return planes_.size() == 3 * pixels();
  return std::all_of(image_->pixels.begin(), image_->pixels.end(),
                     [](const glm::u8vec4& pixel) { return pixel.a == 255; });
}

Image8 StoredImage::operator()() const {
  if (image_) return *image_;
  Image8 image(width_, height_, glm::u8vec4(255));
  const std::vector<std::uint8_t> planes = planes_();
  const std::size_t count = pixels();
  for (std::size_t c = 0; c * count < planes.size(); ++c)
    for (std::size_t p = 0; p < count; ++p) image.pixels[p][int(c)] = planes[c * count + p];
  return image;
}

void StoredImage::remove_alpha() {
  if (is_opaque()) return;
  if (!image_) return planes_.shorten(3 * pixels());
  Image8 image = *image_;
  for (glm::u8vec4& pixel : image.pixels) pixel.a = 255;
  image_ = std::make_shared<const Image8>(std::move(image));
}

void StoredImage::move_to(const std::shared_ptr<ScratchFile>& file) {
  if (!image_) return;
  const std::size_t count = pixels();
  std::vector<std::uint8_t> planes((is_opaque() ? 3 : 4) * count);
  for (std::size_t c = 0; c * count < planes.size(); ++c)
    for (std::size_t p = 0; p < count; ++p) planes[c * count + p] = image_->pixels[p][int(c)];
  StoredBytes stored(std::move(planes));
  stored.move_to(file);
  planes_ = std::move(stored);
  image_.reset();
}

}  // namespace tureen
