#include "runtime/renderer_images.hpp"

namespace tureen {

Image8 RendererImages::image(const FrameInput& input) {
  const auto drawn = [&](float alpha) {
    renderer_.set_background({background_, alpha});
    renderer_.draw(input);
    return renderer_.read_color();
  };
  Image8 image = drawn(1);
  const Image8 covered = drawn(0);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i].a = covered.pixels[i].a;
  return image;
}

}  // namespace tureen
