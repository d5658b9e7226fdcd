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

PresetPromise promise_of_preset(const RenderPreset& preset) {
  return {.knobs = describe(preset), .psnr_db = preset.promised_psnr_db};
}

CheckedRenderer checked_renderer(const PresetPromise& promise, const PresetCandidates& candidates) {
  std::optional<Renderer> quick;
  try {
    quick.emplace(candidates.with_preset());
  } catch (const UsageError& error) {
    return {candidates.without(), "the scene's preset is not obeyed: " + error.reason(), false};
  } catch (const DeviceLimitError& error) {
    return {candidates.without(), "the scene's preset is not obeyed: " + error.reason(), false};
  }
  if (!promise.psnr_db)
    return {std::move(*quick),
            "the scene's preset is obeyed, it promises nothing: " + promise.knobs, true};
  Renderer plain = candidates.without();
  const double psnr = psnr_between(plain, *quick, promise.views);
  const std::string measured = decibels(psnr) + " on four views, " + decibels(*promise.psnr_db) +
                               " promised: " + promise.knobs;
  if (psnr >= *promise.psnr_db - promise_slack_db)
    return {std::move(*quick), "the scene's preset is obeyed, " + measured, true};
  return {std::move(plain), "the scene's preset is not obeyed, " + measured, false};
}

CheckedRenderer checked_renderer(const gl::Context& context, const TriangleSoup& soup,
                                 glm::dvec3 origin, const RenderOptions& options,
                                 const ScenePreset& scene) {
  const auto faithful = [&] { return Renderer(context, soup, origin, options); };
  if (!scene.preset || is_faithful(*scene.preset)) return {faithful(), "", false};
  PresetPromise promise = promise_of_preset(*scene.preset);
  promise.views = scene.views;
  const auto quick = [&] {
    RenderOptions with_preset = options;
    with_preset.plan.preset = combined(*scene.preset, options.plan.preset.value_or(RenderPreset()));
    return Renderer(context, soup, origin, with_preset);
  };
  return checked_renderer(promise, {.with_preset = quick, .without = faithful});
}

}  // namespace tureen
