// A training step on the processor, stage by stage; each stage is a list of independent tasks.
#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <utility>

#include "base/threads/thread_pool.hpp"
#include "scene/triangle_soup.hpp"
#include "trainer/common/cpu/image_loss.hpp"
#include "trainer/common/kernels/random.hpp"
#include "trainer/common/stopwatch.hpp"
#include "trainer/diffsoup/backend.hpp"
#include "trainer/diffsoup/backing.hpp"
#include "trainer/diffsoup/cpu/advantage.hpp"
#include "trainer/diffsoup/cpu/corner_gradient.hpp"
#include "trainer/diffsoup/cpu/face_stage.hpp"
#include "trainer/diffsoup/cpu/shading.hpp"
#include "trainer/diffsoup/cpu/visibility.hpp"

namespace tureen::trainer {

namespace {

constexpr std::size_t faces_a_task = 64;  // enough to hide the cost of starting a task
constexpr std::size_t faces_ahead = 3;    // they take longer than a load from memory

class CpuBackend final : public Backend {
 public:
  CpuBackend(std::span<const TrainingView> views, const Config& config, int threads)
      : views_(views), config_(config), pool_(threads) {
    first_pixel_.push_back(0);
    for (const TrainingView& view : views)
      first_pixel_.push_back(first_pixel_.back() +
                             std::size_t(view.camera.width) * view.camera.height);
  }

  std::string description() const override {
    return fmt::format("CPU, {} thread{}", pool_.threads(), pool_.threads() == 1 ? "" : "s");
  }

  void upload(const TrainingState& state) override;
  void download(TrainingState& state) const override { state = state_; }
  StepReport step(std::span<const std::uint32_t> views, const Rates& rates) override;
  StageTimes take_times() override { return std::exchange(times_, {}); }
  std::vector<std::uint64_t> visible_pixels(std::span<const Camera> cameras) override;
  std::vector<float> render(const Camera& camera) override;

 private:
  void prepare(BatchImage& image, const Camera& camera) const;
  void find_visible_faces(std::span<BatchImage> images, Masking masking);
  void shade(std::span<BatchImage> images);
  void shade_backward(std::span<const std::uint32_t> views, StepReport& report);
  void step_faces(const Rates& rates, StepReport& report);
  void find_views(std::span<const std::uint32_t> views);
  void take_loss(StepReport& report);
  AdvantageInput advantage_input(std::size_t image, std::uint32_t view);
  void step_network(float rate, StepReport& report);
  ShadingInput shading_input() const {
    return {store_.values.data(), state_.model.max_level, &state_.model.mlp, config_.background};
  }

  std::span<const TrainingView> views_;
  Config config_;
  ThreadPool pool_;
  TrainingState state_;
  std::unique_ptr<Pyramid> pyramid_;
  TextureStore store_;
  std::vector<BatchImage> images_;
  std::vector<TrainingView> read_views_;          // of this step, where they are stored
  std::vector<const TrainingView*> batch_views_;  // with pixels, one for each of images_
  std::vector<std::size_t> first_pixel_;          // of each view in the baseline
  std::vector<MlpParameters> mlp_gradients_;
  ImageLossScratch<float> loss_scratch_;
  StageTimes times_;
};

/// A band of rows with the height of a tile. Bands are tasks of equal size for any number of
/// threads.
struct Band {
  std::size_t image;
  int y0, y1;
};

std::vector<Band> bands(std::span<const BatchImage> images) {
  std::vector<Band> result;
  for (std::size_t i = 0; i < images.size(); ++i)
    for (int y = 0; y < images[i].view.height; y += tile_side)
      result.push_back({i, y, std::min(y + tile_side, images[i].view.height)});
  return result;
}

void CpuBackend::upload(const TrainingState& state) {
  state_ = state;
  if (config_.baseline) state_.baseline.resize(first_pixel_.back());
  const Model& model = state_.model;
  state_.errors.resize(model.faces());
  pyramid_ = std::make_unique<Pyramid>(model.min_level, model.max_level);
  store_.values.resize(model.faces() * pyramid_->fine_texels());
  store_.alpha.resize(model.faces() * pyramid_->fine_texels());
  pool_.run((model.faces() + faces_a_task - 1) / faces_a_task, [&](std::size_t task) {
    FaceScratch scratch(*pyramid_);
    const std::size_t end = std::min(model.faces(), (task + 1) * faces_a_task);
    for (std::size_t face = task * faces_a_task; face < end; ++face)
      refresh_texture(*pyramid_, model, face, store_, scratch);
  });
}

void CpuBackend::prepare(BatchImage& image, const Camera& camera) const {
  assert(std::max(camera.width, camera.height) <= kernels::max_image_side);
  image.view = view_of(camera, state_.model.origin, config_.near, config_.far);
  image.tiles_x = (camera.width + tile_side - 1) / tile_side;
  image.tiles_y = (camera.height + tile_side - 1) / tile_side;
  const std::size_t pixels = image.pixels();
  image.visible.resize(pixels);
  image.color.resize(3 * pixels);
}

void CpuBackend::find_visible_faces(std::span<BatchImage> images, Masking masking) {
  const Stopwatch stopwatch(times_.visibility);
  const Model& model = state_.model;
  pool_.run(images.size(), [&](std::size_t i) { bin_faces(images[i], model); });
  const std::vector<Band> tasks = bands(images);
  std::vector<std::uint64_t> fragments(tasks.size());
  pool_.run(tasks.size(), [&](std::size_t task) {
    const Band& band = tasks[task];
    BatchImage& image = images[band.image];
    for (int x = 0; x < image.tiles_x; ++x)
      fragments[task] += find_visible(image, std::size_t(band.y0 / tile_side) * image.tiles_x + x,
                                      store_.alpha.data(), model.max_level, masking);
  });
  pool_.run(images.size(), [&](std::size_t i) {
    if (images[i].keeps_fragments) list_faces(images[i]);
  });
  for (const std::uint64_t count : fragments) times_.fragments += count;
}

void CpuBackend::shade(std::span<BatchImage> images) {
  const Stopwatch stopwatch(times_.shading);
  const std::vector<Band> tasks = bands(images);
  const ShadingInput input = shading_input();
  pool_.run(tasks.size(), [&](std::size_t task) {
    const Band& band = tasks[task];
    shade_rows(images[band.image], input, band.y0, band.y1);
  });
}

void CpuBackend::find_views(std::span<const std::uint32_t> views) {
  read_views_.resize(views.size(), {.camera = {}, .target = {}, .ignored = {}});
  batch_views_.resize(views.size());
  pool_.run(views.size(), [&](std::size_t i) {
    const TrainingView& view = views_[views[i]];
    if (view.stored) read_views_[i] = loaded(view);
    batch_views_[i] = view.stored ? &read_views_[i] : &view;
  });
}

StepReport CpuBackend::step(std::span<const std::uint32_t> views, const Rates& rates) {
  StepReport report;
  const auto step_number = std::uint32_t(state_.step + 1);
  images_.resize(views.size());
  for (std::size_t i = 0; i < views.size(); ++i) {
    BatchImage& image = images_[i];
    prepare(image, views_[views[i]].camera);
    image.draw_key = kernels::draw_key(config_.seed, step_number, views[i]);
    image.by_color.resize(3 * image.pixels());
    image.loss.resize(image.pixels());
    image.features.resize(image.pixels());
  }
  find_views(views);
  find_visible_faces(images_, Masking::stochastic);
  shade(images_);
  take_loss(report);
  shade_backward(views, report);
  step_faces(rates, report);
  step_network(rates.mlp, report);
  state_.step = int(step_number);
  state_.non_finite += report.non_finite;
  ++times_.steps;
  return report;
}

AdvantageInput CpuBackend::advantage_input(std::size_t image, std::uint32_t view) {
  return {.view = batch_views_[image],
          // A pixel's share of the batch's mean.
          .scale = config_.opacity_l1_weight /
                   (float(images_.size()) * 3.0f * float(images_[image].pixels())),
          .baseline_rate = config_.baseline_rate,
          .baseline = config_.baseline ? &state_.baseline[first_pixel_[view]] : nullptr};
}

void CpuBackend::shade_backward(std::span<const std::uint32_t> views, StepReport& report) {
  const Stopwatch stopwatch(times_.shading_backward);
  const std::vector<Band> tasks = bands(images_);
  ShadingInput input = shading_input();
  // Gradients are means over the batch. Scaled to one pixel, they fit the range of a half.
  if (config_.gradient_precision == GradientPrecision::float16)
    input.half_scale = 3.0f * float(images_[0].pixels()) * float(images_.size());
  mlp_gradients_.resize(tasks.size());
  std::vector<BandReport> reports(tasks.size());
  pool_.run(tasks.size(), [&](std::size_t task) {
    const Band& band = tasks[task];
    BatchImage& image = images_[band.image];
    shade_rows_backward(image, input, band.y0, band.y1, mlp_gradients_[task]);
    for (int x = 0; x < image.tiles_x; ++x)
      find_corner_gradients(image, std::size_t(band.y0 / tile_side) * image.tiles_x + x,
                            config_.texture_slide);
    const AdvantageInput advantage = advantage_input(band.image, views[band.image]);
    reports[task] = take_advantage(image, advantage, band.y0, band.y1);
    for (int x = 0; x < image.tiles_x; ++x)
      collect_fragments(image, std::size_t(band.y0 / tile_side) * image.tiles_x + x);
  });
  std::size_t pixels = 0;
  for (const BatchImage& image : images_) pixels += image.pixels();
  for (const BandReport& band : reports) {
    report.mse += band.squared / (3.0 * double(pixels));
    times_.shaded_pixels += band.shaded;
  }
  times_.pixels += pixels;
}

void CpuBackend::step_faces(const Rates& rates, StepReport& report) {
  const Stopwatch stopwatch(times_.faces);
  const FaceStep face_step{.images = images_,
                           .pyramid = pyramid_.get(),
                           .model = &state_.model,
                           .moments = &state_.moments,
                           .store = &store_,
                           .errors = &state_.errors,
                           .texture_rate = rates.texture,
                           .vertex_rate = rates.vertex,
                           .beta1 = config_.beta1,
                           .beta2 = config_.beta2,
                           .epsilon = config_.epsilon,
                           .fixed_faces = backing_faces(config_),
                           .dense_updates = config_.dense_updates};
  const std::size_t faces = state_.model.faces();
  std::vector<unsigned> quarantined((faces + faces_a_task - 1) / faces_a_task);
  pool_.run(quarantined.size(), [&](std::size_t task) {
    FaceScratch scratch(*pyramid_);
    const std::size_t end = std::min(faces, (task + 1) * faces_a_task);
    for (std::size_t face = task * faces_a_task; face < end; ++face) {
      if (face + faces_ahead < end) prefetch_face(images_, face + faces_ahead);
      quarantined[task] += step_face(face_step, face, scratch);
    }
  });
  for (const unsigned count : quarantined) report.non_finite += count;
}

void CpuBackend::take_loss(StepReport& report) {
  const Stopwatch stopwatch(times_.loss);
  const float share = 1.0f / float(images_.size());
  std::vector<ImageLossView<float>> inputs;
  for (std::size_t i = 0; i < images_.size(); ++i) {
    BatchImage& image = images_[i];
    const TrainingView& view = *batch_views_[i];
    inputs.push_back({.width = image.view.width,
                      .height = image.view.height,
                      .rendered = image.color,
                      .target = view.target,
                      .ignored = view.ignored,
                      .l1_weight = config_.l1_weight * share,
                      .ssim_weight = config_.ssim_weight * share,
                      .gradient = image.by_color,
                      .pixel_loss = image.loss});
  }
  std::vector<ImageLoss> losses(images_.size());
  image_losses<float>(inputs, losses, loss_scratch_, pool_);
  for (const ImageLoss& loss : losses) {
    report.loss += loss.loss;
    report.l1 += loss.l1 * share;
    report.ssim += loss.ssim * share;
    report.non_finite += loss.non_finite;
  }
}

void CpuBackend::step_network(float rate, StepReport& report) {
  Moments& moments = state_.moments;
  std::array<double, mlp_parameters> gradient{};
  for (const MlpParameters& part : mlp_gradients_)
    for (std::size_t i = 0; i < mlp_parameters; ++i) gradient[i] += part[i];
  for (const double g : gradient)
    if (!kernels::can_be_squared(float(g))) {
      ++report.non_finite;
      return;
    }
  const kernels::AdamStep adam =
      kernels::adam_step(rate, config_.beta1, config_.beta2, config_.epsilon, ++moments.mlp_steps);
  for (std::size_t i = 0; i < mlp_parameters; ++i)
    kernels::adam(adam, float(gradient[i]), state_.model.mlp[i], moments.mlp_first[i],
                  moments.mlp_second[i]);
}

std::vector<std::uint64_t> CpuBackend::visible_pixels(std::span<const Camera> cameras) {
  std::vector<std::uint64_t> counts(state_.model.faces());
  // A few images at a time, to save memory.
  const std::size_t at_once = 2 * std::size_t(pool_.threads());
  for (std::size_t begin = 0; begin < cameras.size(); begin += at_once) {
    std::vector<BatchImage> images(std::min(at_once, cameras.size() - begin));
    for (std::size_t i = 0; i < images.size(); ++i) {
      prepare(images[i], cameras[begin + i]);
      images[i].keeps_fragments = false;
    }
    find_visible_faces(images, Masking::threshold);
    for (const BatchImage& image : images)
      for (const VisiblePixel& pixel : image.visible)
        if (pixel.face != no_face) ++counts[pixel.face];
  }
  return counts;
}

std::vector<float> CpuBackend::render(const Camera& camera) {
  std::vector<BatchImage> image(1);
  prepare(image[0], camera);
  image[0].keeps_fragments = false;
  find_visible_faces(image, Masking::threshold);
  shade(image);
  return std::move(image[0].color);
}

}  // namespace

std::unique_ptr<Backend> make_cpu_backend(std::span<const TrainingView> views, const Config& config,
                                          int threads) {
  return std::make_unique<CpuBackend>(views, config, threads);
}

}  // namespace tureen::trainer
