#include "trainer/common/training_views.hpp"

#include <algorithm>
#include <cassert>
#include <utility>

#include "scene/scene.hpp"

namespace tureen::trainer {

namespace {

/// One channel over the background, straight alpha. Opaque bytes do not change.
std::uint8_t composited(std::uint8_t value, std::uint8_t alpha, float background) {
  const double opacity = alpha / 255.0;
  return static_cast<std::uint8_t>(opacity * value + (1 - opacity) * 255.0 * background + 0.5);
}

}  // namespace

TrainingView loaded(const TrainingView& view) {
  if (!view.stored) return view;
  TrainingView result{
      .camera = view.camera, .target = view.stored->planes(), .ignored = view.stored->ignored()};
  std::vector<std::uint8_t>& target = result.target;
  const std::size_t pixels = std::size_t(view.camera.width) * std::size_t(view.camera.height);
  assert(target.size() == 3 * pixels || target.size() == 4 * pixels);
  if (target.size() > 3 * pixels)
    for (std::size_t i = 0; i < 3 * pixels; ++i)
      target[i] = composited(target[i], target[3 * pixels + i % pixels],
                             view.stored->background[i / pixels]);
  target.resize(3 * pixels);
  return result;
}

bool has_ignored(const TrainingView& view) {
  return !(view.stored ? view.stored->ignored.empty() : view.ignored.empty());
}

void store(TrainingView& view, const std::shared_ptr<ScratchFile>& file) {
  assert(!view.stored);
  view.stored = {.planes = std::exchange(view.target, {}),
                 .ignored = std::exchange(view.ignored, {})};
  view.stored->planes.move_to(file);
  view.stored->ignored.move_to(file);
}

void expect(const TrainingView& view) {
  if (!view.stored) return;
  view.stored->planes.expect();
  view.stored->ignored.expect();
}

TrainingView training_view(const Photograph& photograph, std::span<const float, 3> background) {
  const Image8 image = photograph.image();
  assert(image.width == photograph.camera.width && image.height == photograph.camera.height);
  const std::size_t pixels = image.pixels.size();
  assert(photograph.ignored.empty() || photograph.ignored.size() == pixels);
  TrainingView view{.camera = photograph.camera, .target = {}, .ignored = photograph.ignored()};
  view.target.resize(3 * pixels);
  for (std::size_t p = 0; p < pixels; ++p) {
    const glm::u8vec4 pixel = image.pixels[p];
    for (int c = 0; c < 3; ++c)
      view.target[std::size_t(c) * pixels + p] =
          composited(pixel[c], pixel.a, background[std::size_t(c)]);
  }
  return view;
}

std::vector<TrainingView> take_training_views(std::vector<Photograph>& photographs,
                                              std::span<const float, 3> background) {
  std::vector<TrainingView> views;
  views.reserve(photographs.size());
  for (Photograph& photograph : photographs) {
    if (photograph.file()) {
      TrainingView& view = views.emplace_back();
      view.camera = photograph.camera;
      view.stored = {.planes = photograph.image.planes(), .ignored = photograph.ignored};
      std::copy(background.begin(), background.end(), view.stored->background.begin());
    } else {
      views.push_back(training_view(photograph, background));
    }
    photograph.image = {};
    photograph.ignored = {};
  }
  return views;
}

Camera relative_to(Camera camera, const glm::dvec3& origin) {
  camera.view_from_world = camera.view_from_world * at_origin(origin);
  return camera;
}

TrainingView halved(const TrainingView& view) {
  assert(!view.stored);
  const auto from_width = std::size_t(view.camera.width),
             from_height = std::size_t(view.camera.height);
  TrainingView result{.camera = view.camera, .target = {}, .ignored = {}};
  Camera& camera = result.camera;
  camera.width /= 2;
  camera.height /= 2;
  for (double* length : {&camera.fx, &camera.fy, &camera.cx, &camera.cy}) *length /= 2;
  const auto width = std::size_t(camera.width), height = std::size_t(camera.height);
  assert(width > 0 && height > 0);
  const auto for_each_four = [&](const std::vector<std::uint8_t>& from, std::size_t plane,
                                 std::vector<std::uint8_t>& to, const auto& of_four) {
    to.resize(to.size() + width * height);
    std::uint8_t* next = to.data() + plane * width * height;
    for (std::size_t y = 0; y < height; ++y)
      for (std::size_t x = 0; x < width; ++x) {
        const std::uint8_t* four = from.data() + (plane * from_height + 2 * y) * from_width + 2 * x;
        *next++ = std::uint8_t(of_four(four[0], four[1], four[from_width], four[from_width + 1]));
      }
  };
  for (std::size_t plane = 0; plane < 3; ++plane)
    for_each_four(view.target, plane, result.target,
                  [](int a, int b, int c, int e) { return (a + b + c + e + 2) / 4; });
  if (!view.ignored.empty())
    for_each_four(view.ignored, 0, result.ignored,
                  [](int a, int b, int c, int e) { return a | b | c | e; });
  return result;
}

TrainingView halved_to(TrainingView view, std::int64_t max_pixels, int min_side) {
  while (std::int64_t(view.camera.width) * view.camera.height > max_pixels &&
         std::min(view.camera.width, view.camera.height) >= 2 * min_side)
    view = halved(view);
  return view;
}

}  // namespace tureen::trainer
