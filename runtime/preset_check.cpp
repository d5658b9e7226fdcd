#include "runtime/preset_check.hpp"

#include <algorithm>
#include <cstdio>
#include <utility>

#include "runtime/navigation.hpp"
#include "soup/error.hpp"
#include "soup/metrics.hpp"

namespace tureen {

namespace {

Camera quartered(const Camera& camera) {
  return resized(camera, std::max(camera.width / 4, 64), std::max(camera.height / 4, 64));
}

std::string decibels(double psnr) {
  char text[32] = {};
  std::snprintf(text, sizeof text, "%.1f dB", psnr);
  std::replace(text, text + sizeof text, ',', '.');
  return text;
}

}  // namespace

std::vector<Camera> preset_views(const Scene& scene) {
  const Subject subject = subject_of(scene);
  const Lens lens{.width = 320, .height = 180};
  constexpr double half_turn = 3.14159265358979324;
  const Bearing front = three_quarter_view, behind{front.azimuth + half_turn, front.elevation};
  std::vector<Camera> views;
  if (scene.cameras.empty()) {
    views = {frame(subject, front, lens), frame(subject, behind, lens)};
  } else {
    const std::size_t middle = scene.cameras.size() / 2;
    views = {quartered(scene.cameras.front()), quartered(scene.cameras[middle])};
  }
  // Close by, faces are large and may reach behind the eye; far away they are smaller than pixels.
  for (const double nearness : {0.35, 4.0}) {
    const double distance = nearness * framing_distance(subject, behind, lens);
    views.push_back(look_at(subject.centre() + distance * direction_of(subject.up, behind),
                            subject.centre(), subject.up, lens.fov_y, lens.width, lens.height));
  }
  return views;
}

double psnr_between(Renderer& a, Renderer& b, std::span<const Camera> views) {
  double squared = 0, pixels = 0;
  for (const Camera& view : views) {
    a.draw(view);
    const ImageF from_a = to_float(a.read_color());
    b.draw(view);
    const ImageF from_b = to_float(b.read_color());
    const double count = double(view.width) * view.height;
    squared += mean_squared_error(from_a, from_b) * count;
    pixels += count;
  }
  return psnr_from_mse(squared / pixels);
}

double measured_promise(const gl::Context& context, const Scene& scene,
                        const RenderPreset& preset) {
  const auto& soup = std::get<TriangleSoup>(scene.primitives);
  const RenderOptions options{.background = glm::vec4(scene.info.background, 1.0f)};
  RenderOptions with_preset = options;
  with_preset.plan.preset = preset;
  Renderer faithful(context, soup, scene.origin, options);
  Renderer quick(context, soup, scene.origin, with_preset);
  return psnr_between(faithful, quick, preset_views(scene));
}

CheckedRenderer checked_renderer(const gl::Context& context, const TriangleSoup& soup,
                                 glm::dvec3 origin, const RenderOptions& options,
                                 const ScenePreset& scene) {
  const auto faithful = [&](std::string sentence) -> CheckedRenderer {
    return {Renderer(context, soup, origin, options), std::move(sentence), false};
  };
  if (!scene.preset || is_faithful(*scene.preset)) return faithful("");
  RenderOptions quick_options = options;
  quick_options.plan.preset = combined(*scene.preset, options.plan.preset.value_or(RenderPreset()));
  const std::string knobs = describe(*scene.preset);
  std::optional<Renderer> quick;
  try {
    quick.emplace(context, soup, origin, quick_options);
  } catch (const UsageError& error) {
    return faithful("the scene's preset is not obeyed: " + error.reason());
  } catch (const DeviceLimitError& error) {
    return faithful("the scene's preset is not obeyed: " + error.reason());
  }
  const std::optional<double>& promised = scene.preset->promised_psnr_db;
  if (!promised)
    return {std::move(*quick), "the scene's preset is obeyed, it promises nothing: " + knobs, true};
  CheckedRenderer plain = faithful("");
  const double psnr = psnr_between(plain.renderer, *quick, scene.views);
  const std::string measured =
      decibels(psnr) + " on four views, " + decibels(*promised) + " promised: " + knobs;
  if (psnr >= *promised - promise_slack_db)
    return {std::move(*quick), "the scene's preset is obeyed, " + measured, true};
  plain.sentence = "the scene's preset is not obeyed, " + measured;
  return plain;
}

}  // namespace tureen
