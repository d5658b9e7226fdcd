#include "jobs/compress/judge.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "base/error.hpp"
#include "camera/camera_sets.hpp"
#include "image/metrics.hpp"
#include "image/render_error.hpp"
#include "runtime/renderer.hpp"

namespace tureen {

namespace {

constexpr std::size_t judged_views = 24;
constexpr std::size_t hemisphere_views = 64;
constexpr int max_pixels = 800;  // a side

Camera limited(const Camera& camera) {
  const double scale = double(max_pixels) / std::max(camera.width, camera.height);
  if (scale >= 1) return camera;
  return resized(camera, std::max(1, int(camera.width * scale)),
                 std::max(1, int(camera.height * scale)));
}

}  // namespace

std::vector<Camera> compress_views(const Scene& scene, std::span<const Camera> recorded,
                                   std::size_t count) {
  std::vector<Camera> views;
  const std::size_t some = std::min(count, recorded.size());
  for (std::size_t i = 0; i < some; ++i)
    views.push_back(limited(recorded[i * recorded.size() / some]));
  if (recorded.size() >= min_representative_cameras || some == count) return views;
  const std::vector<Camera> around =
      hemisphere(subject_of(scene), int(std::min(count - some, hemisphere_views)),
                 {.width = max_pixels, .height = 600});
  views.insert(views.end(), around.begin(), around.end());
  return views;
}

CompressJudge::CompressJudge(const gl::Context& context, const Scene& scene,
                             std::span<const Photograph> photographs, Cancel cancel)
    : context_(context),
      cancel_(std::move(cancel)),
      origin_(origin_of(only_layer(scene))),
      background_(scene.info.background) {
  for (const Photograph& photograph : photographs) {
    cameras_.push_back(photograph.camera);
    photographs_.push_back(composited(to_float(photograph.image()), background_));
    ignored_.push_back(photograph.ignored());
  }
  if (!photographs_.empty()) {
    views_.photographs = photographs_.size();
  } else {
    cameras_ = compress_views(scene, scene.cameras, judged_views);
    views_.recorded = scene.cameras.size();
    views_.cameras = std::min(views_.recorded, cameras_.size());
    views_.around = cameras_.size() - views_.cameras;
  }
  std::vector<double> errors;
  draw(only_soup(scene), [&](std::size_t i, const ImageF& image) {
    images_.push_back(image);
    if (!photographs_.empty()) errors.push_back(photograph_error(i, image));
  });
  if (photographs_.empty()) return;
  model_db_ = model_db(errors);
  if (model_db_ < hopeless_db)
    throw UsageError(fmt::format("the PSNR of the scene against these photographs is only {:.2f} "
                                 "dB: they most likely show another scene",
                                 model_db_),
                     "omit --photographs to estimate the loss");
}

CompressLoss CompressJudge::loss(const TriangleSoup& soup) const {
  double squared = 0, pixels = 0;
  std::vector<double> errors;
  draw(soup, [&](std::size_t i, const ImageF& image) {
    const auto weight = double(cameras_[i].width) * cameras_[i].height;
    squared += weight * mean_squared_error(images_[i], image);
    pixels += weight;
    if (!photographs_.empty()) errors.push_back(photograph_error(i, image));
  });
  CompressLoss result;
  result.render_psnr_db = psnr_from_mse(squared / pixels);
  result.db = photographs_.empty() ? decibels_lost(model_db_, result.render_psnr_db)
                                   : model_db_ - model_db(errors);
  return result;
}

double CompressJudge::photograph_error(std::size_t view, const ImageF& image) const {
  const std::vector<std::uint8_t>& ignored = ignored_[view];
  if (ignored.empty()) return mean_squared_error(photographs_[view], image);
  ImageF equated = photographs_[view];
  const double counted = equate_ignored(image, ignored, equated);
  return counted * mean_squared_error(equated, image);
}

double CompressJudge::model_db(const std::vector<double>& squared_errors) const {
  double sum = 0;
  for (const double mse : squared_errors) sum += psnr_from_mse(mse);
  return sum / double(squared_errors.size());
}

void CompressJudge::draw(const TriangleSoup& soup,
                         const std::function<void(std::size_t, const ImageF&)>& visit) const {
  Renderer renderer(context_, prepare_scene(soup, origin_, device_limits(context_.capabilities())),
                    {.background = {background_, 1.0f}});
  for (std::size_t i = 0; i < cameras_.size(); ++i) {
    if (cancel_) cancel_();
    renderer.draw({cameras_[i]});
    visit(i, to_float(renderer.read_color()));
  }
}

}  // namespace tureen
