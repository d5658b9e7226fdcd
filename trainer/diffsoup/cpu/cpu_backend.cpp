// A training step on the processor, stage by stage; each stage is a list of independent tasks.
#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <chrono>
#include <cmath>
#include <utility>

#include "scene/triangle_soup.hpp"
#include "trainer/common/cpu/image_loss.hpp"
#include "trainer/common/cpu/thread_pool.hpp"
#include "trainer/common/kernels/random.hpp"
#include "trainer/diffsoup/backend.hpp"
#include "trainer/diffsoup/cpu/face_stage.hpp"
#include "trainer/diffsoup/cpu/shading.hpp"
#include "trainer/diffsoup/cpu/visibility.hpp"

namespace tureen::trainer {

namespace {

/// Adds the seconds of its life to a sum.
class Stopwatch {
 public:
  explicit Stopwatch(double& sum) : sum_(sum) {}
  Stopwatch(const Stopwatch&) = delete;
  Stopwatch& operator=(const Stopwatch&) = delete;
  ~Stopwatch() {
    sum_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  double& sum_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

constexpr std::size_t faces_a_task = 64;  // enough to hide the cost of handing a task out

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
  void prepare(Picture& picture, const Camera& camera) const;
  void find_visible_faces(std::span<Picture> pictures, Masking masking);
  void shade(std::span<Picture> pictures);
  void shade_backward(std::span<const std::uint32_t> views, StepReport& report);
  void step_faces(const Rates& rates, StepReport& report);
  void take_loss(std::span<const std::uint32_t> views, StepReport& report);
  struct BandReport {
    double squared = 0;  // sum of (C - G)^2
    std::uint64_t shaded = 0;
  };
  BandReport take_advantage(Picture& picture, std::uint32_t view_index, int y0, int y1);
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
  std::vector<Picture> pictures_;
  std::vector<std::size_t> first_pixel_;  // of each view in the baseline
  std::vector<MlpParameters> mlp_gradients_;
  ImageLossScratch<float> loss_scratch_;
  StageTimes times_;
};

/// The rows of all pictures in bands of one tile's height: tasks of equal size, whatever the
/// number of threads.
struct Band {
  std::size_t picture;
  int y0, y1;
};

std::vector<Band> bands(std::span<const Picture> pictures) {
  std::vector<Band> result;
  for (std::size_t i = 0; i < pictures.size(); ++i)
    for (int y = 0; y < pictures[i].view.height; y += tile_side)
      result.push_back({i, y, std::min(y + tile_side, pictures[i].view.height)});
  return result;
}

void CpuBackend::upload(const TrainingState& state) {
  state_ = state;
  if (config_.baseline) state_.baseline.resize(first_pixel_.back());
  const Model& model = state_.model;
  state_.errors.resize(model.faces());
  pyramid_ = std::make_unique<Pyramid>(model.min_level, model.max_level);
  store_.values.resize(model.faces() * pyramid_->fine_texels() * channels);
  store_.alpha.resize(model.faces() * pyramid_->fine_texels());
  pool_.run((model.faces() + faces_a_task - 1) / faces_a_task, [&](std::size_t task) {
    FaceScratch scratch(*pyramid_);
    const std::size_t end = std::min(model.faces(), (task + 1) * faces_a_task);
    for (std::size_t face = task * faces_a_task; face < end; ++face)
      refresh_texture(*pyramid_, model, face, store_, scratch);
  });
}

void CpuBackend::prepare(Picture& picture, const Camera& camera) const {
  assert(std::max(camera.width, camera.height) <= kernels::most_picture_side);
  picture.view = view_of(camera, state_.model.origin, config_.near, config_.far);
  picture.tiles_x = (camera.width + tile_side - 1) / tile_side;
  picture.tiles_y = (camera.height + tile_side - 1) / tile_side;
  const std::size_t pixels = picture.pixels();
  picture.visible.resize(pixels);
  picture.color.resize(3 * pixels);
}

void CpuBackend::find_visible_faces(std::span<Picture> pictures, Masking masking) {
  const Stopwatch stopwatch(times_.visibility);
  const Model& model = state_.model;
  pool_.run(pictures.size(), [&](std::size_t i) { bin_faces(pictures[i], model); });
  const std::vector<Band> tasks = bands(pictures);
  std::vector<std::uint64_t> fragments(tasks.size());
  pool_.run(tasks.size(), [&](std::size_t task) {
    const Band& band = tasks[task];
    Picture& picture = pictures[band.picture];
    for (int x = 0; x < picture.tiles_x; ++x)
      fragments[task] +=
          find_visible(picture, std::size_t(band.y0 / tile_side) * picture.tiles_x + x,
                       store_.alpha.data(), model.max_level, masking);
  });
  for (const std::uint64_t count : fragments) times_.fragments += count;
}

void CpuBackend::shade(std::span<Picture> pictures) {
  const Stopwatch stopwatch(times_.shading);
  const std::vector<Band> tasks = bands(pictures);
  const ShadingInput input = shading_input();
  pool_.run(tasks.size(), [&](std::size_t task) {
    const Band& band = tasks[task];
    shade_rows(pictures[band.picture], input, band.y0, band.y1);
  });
}

StepReport CpuBackend::step(std::span<const std::uint32_t> views, const Rates& rates) {
  StepReport report;
  const auto step_number = std::uint32_t(state_.step + 1);
  pictures_.resize(views.size());
  for (std::size_t i = 0; i < views.size(); ++i) {
    Picture& picture = pictures_[i];
    prepare(picture, views_[views[i]].camera);
    picture.draw_key = kernels::draw_key(config_.seed, step_number, views[i]);
    picture.by_color.resize(3 * picture.pixels());
    picture.loss.resize(picture.pixels());
    picture.gradient.resize(picture.pixels());
  }
  find_visible_faces(pictures_, Masking::stochastic);
  shade(pictures_);
  take_loss(views, report);
  shade_backward(views, report);
  step_faces(rates, report);
  step_network(rates.mlp, report);
  state_.step = int(step_number);
  state_.non_finite += report.non_finite;
  ++times_.steps;
  return report;
}

void CpuBackend::shade_backward(std::span<const std::uint32_t> views, StepReport& report) {
  const Stopwatch stopwatch(times_.shading_backward);
  const std::vector<Band> tasks = bands(pictures_);
  ShadingInput input = shading_input();
  // Gradients are means over the batch: scaled to a pixel's own they suit the range of a half.
  if (config_.gradient_precision == GradientPrecision::float16)
    input.half_scale = 3.0f * float(pictures_[0].pixels()) * float(pictures_.size());
  mlp_gradients_.resize(tasks.size());
  std::vector<BandReport> reports(tasks.size());
  pool_.run(tasks.size(), [&](std::size_t task) {
    const Band& band = tasks[task];
    Picture& picture = pictures_[band.picture];
    shade_rows_backward(picture, input, band.y0, band.y1, mlp_gradients_[task]);
    reports[task] = take_advantage(picture, views[band.picture], band.y0, band.y1);
  });
  std::size_t pixels = 0;
  for (const Picture& picture : pictures_) pixels += picture.pixels();
  for (const BandReport& band : reports) {
    report.mse += band.squared / (3.0 * double(pixels));
    times_.shaded_pixels += band.shaded;
  }
  times_.pixels += pixels;
}

void CpuBackend::step_faces(const Rates& rates, StepReport& report) {
  const Stopwatch stopwatch(times_.faces);
  const FaceStep face_step{.pictures = pictures_,
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
                           .slide = config_.texture_slide,
                           .dense_updates = config_.dense_updates};
  const std::size_t faces = state_.model.faces();
  std::vector<unsigned> quarantined((faces + faces_a_task - 1) / faces_a_task);
  pool_.run(quarantined.size(), [&](std::size_t task) {
    FaceScratch scratch(*pyramid_);
    const std::size_t end = std::min(faces, (task + 1) * faces_a_task);
    for (std::size_t face = task * faces_a_task; face < end; ++face)
      quarantined[task] += step_face(face_step, face, scratch);
  });
  for (const unsigned count : quarantined) report.non_finite += count;
}

void CpuBackend::take_loss(std::span<const std::uint32_t> views, StepReport& report) {
  const Stopwatch stopwatch(times_.loss);
  const float share = 1.0f / float(views.size());
  std::vector<ImageLossView<float>> inputs;
  for (std::size_t i = 0; i < views.size(); ++i) {
    Picture& picture = pictures_[i];
    const TrainingView& view = views_[views[i]];
    inputs.push_back({.width = picture.view.width,
                      .height = picture.view.height,
                      .rendered = picture.color,
                      .target = view.target,
                      .ignored = view.ignored,
                      .l1_weight = config_.l1_weight * share,
                      .ssim_weight = config_.ssim_weight * share,
                      .gradient = picture.by_color,
                      .pixel_loss = picture.loss});
  }
  std::vector<ImageLoss> losses(views.size());
  image_losses<float>(inputs, losses, loss_scratch_, pool_);
  for (const ImageLoss& loss : losses) {
    report.loss += loss.loss;
    report.l1 += loss.l1 * share;
    report.ssim += loss.ssim * share;
    report.non_finite += loss.non_finite;
  }
}

/// What a band of rows adds to the statistics, and its pixels' loss turned into what the score
/// takes: its share of the batch's mean, less the running mean, which runs on.
CpuBackend::BandReport CpuBackend::take_advantage(Picture& picture, std::uint32_t view_index,
                                                  int y0, int y1) {
  BandReport report;
  const TrainingView& view = views_[view_index];
  const std::size_t pixels = picture.pixels(), width = std::size_t(picture.view.width);
  const float scale = config_.opacity_l1_weight / (float(pictures_.size()) * 3.0f * float(pixels));
  for (std::size_t p = std::size_t(y0) * width; p < std::size_t(y1) * width; ++p) {
    report.shaded += picture.visible[p].face != no_face;
    bool counts = view.ignored.empty() || !view.ignored[p];
    for (std::size_t c = 0; counts && c < 3; ++c) {
      const double d = picture.color[c * pixels + p] - view.target[c * pixels + p] / 255.0;
      if (std::isfinite(d)) report.squared += d * d;
    }
    for (std::size_t c = 0; c < 3; ++c)
      counts = counts && std::isfinite(picture.color[c * pixels + p]);
    float loss = picture.loss[p];
    picture.gradient[p].error = loss;
    // A pixel that does not count has a loss of 0, which says nothing of what it mostly shows.
    if (config_.baseline && counts) {
      std::uint16_t& stored = state_.baseline[first_pixel_[view_index] + p];
      const float root = float(stored) / 65535;
      const float mean = 3 * root * root;  // of sum |C - G|, which is in [0, 3]
      const float next = stored ? mean + config_.baseline_rate * (loss - mean) : loss;
      stored = std::uint16_t(std::clamp(65535 * std::sqrt(next / 3) + 0.5f, 1.0f, 65535.0f));
      loss -= mean;
    }
    picture.loss[p] = loss * scale;
  }
  return report;
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
  // A few pictures at a time: they are counted and forgotten.
  const std::size_t at_once = 2 * std::size_t(pool_.threads());
  for (std::size_t begin = 0; begin < cameras.size(); begin += at_once) {
    std::vector<Picture> pictures(std::min(at_once, cameras.size() - begin));
    for (std::size_t i = 0; i < pictures.size(); ++i) prepare(pictures[i], cameras[begin + i]);
    find_visible_faces(pictures, Masking::threshold);
    for (const Picture& picture : pictures)
      for (const VisiblePixel& pixel : picture.visible)
        if (pixel.face != no_face) ++counts[pixel.face];
  }
  return counts;
}

std::vector<float> CpuBackend::render(const Camera& camera) {
  std::vector<Picture> picture(1);
  prepare(picture[0], camera);
  find_visible_faces(picture, Masking::threshold);
  shade(picture);
  return std::move(picture[0].color);
}

}  // namespace

std::unique_ptr<Backend> make_cpu_backend(std::span<const TrainingView> views, const Config& config,
                                          int threads) {
  return std::make_unique<CpuBackend>(views, config, threads);
}

}  // namespace tureen::trainer
