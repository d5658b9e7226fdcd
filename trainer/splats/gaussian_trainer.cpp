#include "trainer/splats/gaussian_trainer.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <glm/geometric.hpp>

#include "trainer/common/random_points.hpp"
#include "trainer/common/stopwatch.hpp"

namespace tureen::trainer {

namespace row = splatting::gaussian_row;

namespace {

constexpr std::size_t squares_a_sum = 512;  // in single precision

}  // namespace

GaussianParameters random_gaussians(const GaussianConfig& config, const Region& region,
                                    Random& random) {
  GaussianParameters result(config.first_splats, config.degree);
  const double scale =
      0.5 * region.half_side * std::cbrt(1 / double(std::max<std::size_t>(config.first_splats, 1)));
  const auto near = result.count() - std::size_t(config.far_splats * double(result.count()));
  for (std::size_t i = 0; i < result.count(); ++i) {
    const glm::dvec3 point =
        i < near ? near_point(region, random) : far_point(region, config.far_extent, random);
    const double distance = glm::distance(point, region.centre) / region.half_side;
    for (int axis = 0; axis < 3; ++axis) {
      result.trained(row::x + std::size_t(axis))[i] = float(point[axis]);
      result.trained(row::scale_x + std::size_t(axis))[i] =
          float(std::log(scale * (i < near ? 1 : distance)));
    }
    result.trained(row::rotation_w)[i] = 1;
    result.trained(row::opacity)[i] = std::log(config.first_opacity / (1 - config.first_opacity));
    result.activate(i);
  }
  return result;
}

GaussianTrainer::GaussianTrainer(const GaussianConfig& config, std::span<const TrainingView> views,
                                 const Region& region, int threads)
    : config_(config),
      views_(views),
      region_(region),
      pool_(threads),
      raster_(pool_),
      random_(config.seed) {
  assert(!views.empty() && config.degree <= max_trained_degree);
  parameters_ = random_gaussians(config_, region, random_);
  memory_ = SplatMemory(parameters_.rows(), parameters_.count());
}

GaussianTrainer::GaussianTrainer(const GaussianConfig& config, std::span<const TrainingView> views,
                                 const Region& region, int threads, GaussianState state)
    : config_(config),
      views_(views),
      region_(region),
      pool_(threads),
      raster_(pool_),
      parameters_(std::move(state.parameters)),
      memory_(std::move(state.memory)),
      random_(state.random),
      step_(state.step),
      epoch_(std::move(state.epoch)) {
  assert(!views.empty() && config.degree == parameters_.degree);
}

GaussianState GaussianTrainer::state() const {
  return {.parameters = parameters_,
          .memory = memory_,
          .random = random_,
          .step = step_,
          .epoch = epoch_};
}

double GaussianTrainer::last_mse() const {
  const std::vector<std::uint8_t>&target = last_view_->target, &ignored = last_view_->ignored;
  const std::size_t plane = target.size() / 3;
  double sum = 0, values = 0;
  for (std::size_t i = 0; i < target.size(); i += squares_a_sum) {
    const std::size_t count = std::min(squares_a_sum, target.size() - i);
    float squares[squares_a_sum];
    for (std::size_t k = 0; k < count; ++k) {
      const float difference = planes_[i + k] - float(target[i + k]) / 255.0f;
      squares[k] = difference * difference;
    }
    for (std::size_t k = 0; k < count && !ignored.empty(); ++k)
      if (ignored[(i + k) % plane]) squares[k] = 0;
    float lanes[8] = {};
    for (std::size_t k = 0; k < count; ++k) lanes[k % 8] += squares[k];
    for (const float lane : lanes) sum += double(lane);
  }
  for (const std::uint8_t each : ignored) values += each ? 0 : 3;
  if (ignored.empty()) values = double(target.size());
  return values > 0 ? sum / values : 0;
}

int GaussianTrainer::degree_now() const {
  const int reached = int(step_ / std::max(1.0, config_.degree_steps * config_.steps));
  return std::min(config_.degree, reached);
}

const TrainingView& GaussianTrainer::next_view() {
  if (epoch_.empty()) epoch_ = draw(random_, views_.size(), views_.size());
  const bool half = step_ < config_.half_size_until * config_.steps;
  if (half && half_views_.empty())
    for (const TrainingView& each : views_) half_views_.push_back(halved(each));
  if (!half) half_views_ = {};
  const TrainingView& view = half ? half_views_[epoch_.back()] : views_[epoch_.back()];
  epoch_.pop_back();
  return view;
}

GaussianStepReport GaussianTrainer::step() {
  assert(!done());
  const TrainingView& view = next_view();
  last_view_ = &view;
  const int width = view.camera.width, height = view.camera.height;
  planes_.resize(3 * std::size_t(width) * std::size_t(height));
  gradient_.resize(planes_.size());
  raster_.forward(parameters_, view.camera, degree_now(),
                  std::span<const float, 3>(config_.background), planes_);
  GaussianStepReport report;
  {
    const Stopwatch watch(times().loss);
    const ImageLoss loss = image_loss<float>({.width = width,
                                              .height = height,
                                              .rendered = planes_,
                                              .target = view.target,
                                              .ignored = view.ignored,
                                              .l1_weight = config_.l1_weight,
                                              .ssim_weight = config_.ssim_weight,
                                              .gradient = gradient_},
                                             loss_scratch_, pool_);
    report = {.loss = loss.loss, .l1 = loss.l1, .ssim = loss.ssim, .quarantined = loss.non_finite};
  }
  const GaussianBackwardInput input = raster_.backward(planes_, gradient_);
  {
    const Stopwatch watch(times().update);
    const double done = double(step_) / config_.steps;
    GaussianStep step{.rates = {},
                      .min_log_scale = float(std::log(config_.min_scale * region_.half_side)),
                      .max_log_scale = float(std::log(config_.max_scale * region_.half_side))};
    for (std::size_t k = 0; k < gaussian_parameter_kinds.size(); ++k) {
      const ParameterKind& kind = gaussian_parameter_kinds[k];
      step.rates[k] = float(kind.rate * std::pow(double(kind.last_rate) / kind.rate, done));
    }
    step.rates[0] *= float(region_.half_side);
    const std::size_t count = parameters_.count();
    std::vector<std::size_t> quarantined((count + splats_a_task - 1) / splats_a_task);
    pool_.run(quarantined.size(), [&](std::size_t task) {
      const std::size_t begin = task * splats_a_task;
      quarantined[task] = step_gaussians(input, step, begin, std::min(begin + splats_a_task, count),
                                         parameters_, memory_);
    });
    for (const std::size_t each : quarantined) report.quarantined += each;
  }
  ++times().steps;
  ++step_;
  // Short runs densify more often, or they would end with few splats.
  const int every = std::min(config_.densify_every, std::max(config_.steps / 25, 20));
  if (step_ % every == 0 && step_ <= config_.densify_until * config_.steps) {
    const Stopwatch watch(times().update);
    const DensifyReport densified =
        densify({.max_splats = config_.max_splats, .growth = config_.growth}, random_, parameters_,
                memory_);
    if (densified.dead == parameters_.count()) {
      // No splat is left to split: the run begins again, at other places.
      GaussianConfig limited = config_;
      limited.first_splats = std::min(config_.first_splats, config_.max_splats);
      parameters_ = random_gaussians(limited, region_, random_);
      memory_ = SplatMemory(parameters_.rows(), parameters_.count());
    }
    sort_in_memory(region_, parameters_, memory_);
    report.dead = densified.dead;
    report.split = densified.split;
  }
  return report;
}

std::vector<float> GaussianTrainer::render(const Camera& camera) {
  const SplatTimes times = raster_.times();
  std::vector<float> planes(3 * std::size_t(camera.width) * std::size_t(camera.height));
  raster_.forward(parameters_, camera, config_.degree,
                  std::span<const float, 3>(config_.background), planes);
  raster_.times() = times;
  return planes;
}

}  // namespace tureen::trainer
