#include "trainer/splats/window_trainer.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "scene/opaque_windows.hpp"
#include "trainer/common/neighbours.hpp"
#include "trainer/common/stopwatch.hpp"

namespace tureen::trainer {

namespace window_row = splatting::window_row;

namespace {

constexpr std::size_t windows_a_task = 1024;
/// Steps between changes of the limits of opaque training; each change is a pass over all windows.
constexpr int anneal_every = 10;

/// The value of the constant spherical harmonic, 1 / (2 sqrt(pi)).
constexpr double constant_harmonic = 0.28209479177387814;

void place_window(WindowParameters& parameters, std::size_t i, const glm::dvec3& center,
                  double radius, const WindowConfig& config, Random& random) {
  const glm::dmat3 rotation = random.rotation();
  for (int k = 0; k < 3; ++k) {
    const double angle = k * 2.0943951023931953;
    const glm::dvec3 corner =
        center + rotation * glm::dvec3(radius * std::cos(angle), radius * std::sin(angle), 0);
    for (int axis = 0; axis < 3; ++axis)
      parameters.trained(window_row::corners + std::size_t(3 * k + axis))[i] = float(corner[axis]);
  }
  parameters.trained(window_row::sigma)[i] = WindowParameters::log_of_sigma(config.first_sigma);
  parameters.trained(window_row::opacity)[i] = parameters.logit_of(config.first_opacity);
  parameters.activate(i);
}

/// Grey windows, uniform in the cube of the region.
WindowParameters random_windows(const WindowConfig& config, const Region& region, Random& random) {
  WindowParameters result(config.first_splats, config.degree);
  const double spacing =
      2 * region.half_side / std::cbrt(double(std::max<std::size_t>(config.first_splats, 1)));
  for (std::size_t i = 0; i < result.count(); ++i) {
    glm::dvec3 center = region.centre;
    for (int axis = 0; axis < 3; ++axis) center[axis] += region.half_side * random.uniform(-1, 1);
    place_window(result, i, center, config.first_size * spacing, config, random);
  }
  return result;
}

/// At points that are drawn from `points`. Coincident points have the size of random ones.
WindowParameters windows_at(std::span<const DatasetPoint> points, const WindowConfig& config,
                            const Region& region, Random& random) {
  const std::size_t count = std::min(config.first_splats, points.size());
  std::vector<glm::dvec3> centers;
  std::vector<glm::u8vec3> colors;
  for (const std::uint32_t which : draw(random, count, points.size())) {
    centers.push_back(points[which].position);
    colors.push_back(points[which].color);
  }
  const std::vector<double> distances = nearest_distances(centers);
  const double spacing = 2 * region.half_side / std::cbrt(double(std::max<std::size_t>(count, 1)));
  WindowParameters result(count, config.degree);
  for (std::size_t i = 0; i < count; ++i) {
    const double distance = distances[i] > 0 ? std::min(distances[i], spacing) : spacing;
    place_window(result, i, centers[i], config.first_size * 2 * distance, config, random);
    for (int channel = 0; channel < 3; ++channel)
      result.trained(window_row::harmonics + std::size_t(channel))[i] =
          float((colors[i][channel] / 255.0 - 0.5) / constant_harmonic);
  }
  return result;
}

}  // namespace

WindowTrainer::WindowTrainer(const WindowConfig& config, std::span<const TrainingView> views,
                             const Region& region, int threads,
                             std::span<const DatasetPoint> points)
    : config_(config),
      views_(views),
      region_(region),
      pool_(threads),
      raster_(pool_),
      random_(config.seed) {
  assert(!views.empty() && config.degree <= max_trained_degree);
  parameters_ = points.empty() ? random_windows(config_, region, random_)
                               : windows_at(points, config_, region, random_);
  memory_ = SplatMemory(parameters_.rows(), parameters_.count());
}

int WindowTrainer::degree_now() const {
  const int reached = int(step_ / std::max(1.0, config_.degree_steps * config_.steps));
  return std::min(config_.degree, reached);
}

const TrainingView& WindowTrainer::next_view() {
  if (epoch_.empty()) epoch_ = draw(random_, views_.size(), views_.size());
  const TrainingView& view = views_[epoch_.back()];
  epoch_.pop_back();
  return view;
}

std::size_t WindowTrainer::update(const WindowBackwardInput& input) {
  const double done = double(step_) / config_.steps;
  const std::size_t count = parameters_.count();
  const auto per_window = [&](float weight) {
    return weight / float(std::max(count, std::size_t(1)));
  };
  WindowStep step{.rates = {}};
  step.loss.opacity = per_window(config_.opacity_weight);
  if (done < config_.size_until) step.loss.inverse_area = per_window(config_.size_weight);
  for (std::size_t k = 0; k < window_parameter_kinds.size(); ++k) {
    const ParameterKind& kind = window_parameter_kinds[k];
    step.rates[k] = float(kind.rate * std::pow(double(kind.last_rate) / kind.rate, done));
  }
  step.rates[0] *= float(region_.half_side * config_.rate_factor);
  std::vector<std::size_t> quarantined((count + windows_a_task - 1) / windows_a_task);
  pool_.run(quarantined.size(), [&](std::size_t task) {
    const std::size_t begin = task * windows_a_task;
    quarantined[task] = step_windows(input, step, begin, std::min(begin + windows_a_task, count),
                                     parameters_, memory_);
  });
  std::size_t sum = 0;
  for (const std::size_t each : quarantined) sum += each;
  return sum;
}

void WindowTrainer::anneal() {
  const double done = double(step_) / config_.steps;
  if (!config_.opaque || done < config_.opaque_from || step_ % anneal_every != 0) return;
  const double part = std::clamp(
      (done - config_.opaque_from) / (config_.opaque_until - config_.opaque_from), 0.0, 1.0);
  // Sigma falls by the same factor in equal times; the floor of opacity rises evenly.
  const double max_sigma =
      config_.first_sigma * std::pow(double(config_.last_sigma) / config_.first_sigma, part);
  const float max_log = WindowParameters::log_of_sigma(float(max_sigma));
  const float floor = float(part) * config_.last_min_opacity;
  for (std::size_t i = 0; i < parameters_.count(); ++i) {
    float& log_sigma = parameters_.trained(window_row::sigma)[i];
    log_sigma = std::min(log_sigma, max_log);
  }
  const std::vector<float> opacity(
      parameters_.drawn.row(window_row::opacity),
      parameters_.drawn.row(window_row::opacity) + parameters_.count());
  const bool rises = floor > parameters_.min_opacity;
  parameters_.min_opacity = std::max(floor, parameters_.min_opacity);
  for (std::size_t i = 0; i < parameters_.count(); ++i) {
    if (rises) parameters_.trained(window_row::opacity)[i] = parameters_.logit_of(opacity[i]);
    parameters_.activate(i);
  }
}

WindowDensifyReport WindowTrainer::densify() {
  WindowDensifyOptions options{
      .max_splats = config_.max_splats, .overlap = config_.overlap, .sampling = config_.sampling};
  if (config_.opaque && double(step_) / config_.steps >= config_.prune_from)
    options.min_opacity = config_.min_opacity_before_opaque;
  if (config_.alternate_sampling)
    options.sampling =
        densifications_ % 2 == 0 ? WindowSampling::opacity : WindowSampling::inverse_sigma;
  ++densifications_;
  const WindowDensifyReport report = densify_windows(options, random_, parameters_, memory_);
  std::vector<glm::vec3> centers(parameters_.count());
  for (std::size_t i = 0; i < centers.size(); ++i)
    for (std::size_t k = 0; k < 9; ++k)
      centers[i][int(k % 3)] += parameters_.trained(window_row::corners + k)[i] / 3;
  const std::vector<std::uint32_t> order = morton_order(centers, region_);
  parameters_.reorder(order);
  memory_.reorder(order);
  return report;
}

WindowStepReport WindowTrainer::step() {
  assert(!done());
  const TrainingView& view = next_view();
  const int width = view.camera.width, height = view.camera.height;
  planes_.resize(3 * std::size_t(width) * std::size_t(height));
  gradient_.resize(planes_.size());
  raster_.forward(parameters_, view.camera, degree_now(),
                  std::span<const float, 3>(config_.background), planes_);
  WindowStepReport report;
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
  const WindowBackwardInput input = raster_.backward(planes_, gradient_);
  const Stopwatch watch(times().update);
  report.quarantined += update(input);
  ++times().steps;
  ++step_;
  if (step_ % config_.densify_every == 0 && step_ <= config_.densify_until * config_.steps) {
    const WindowDensifyReport densified = densify();
    report.dead = densified.dead;
    report.split = densified.split;
  }
  anneal();
  return report;
}

std::vector<float> WindowTrainer::render(const Camera& camera) {
  const SplatTimes times = raster_.times();
  std::vector<float> planes(3 * std::size_t(camera.width) * std::size_t(camera.height));
  raster_.forward(parameters_, camera, config_.degree,
                  std::span<const float, 3>(config_.background), planes);
  raster_.times() = times;
  return planes;
}

TriangleSoup WindowTrainer::to_soup() const {
  Splats splats = parameters_.splats();
  keep_windows(splats, [&](std::size_t i) {
    return memory_.statistics.row(splat_statistic::evident)[i] > 0;
  });
  return to_opaque(std::move(splats)).soup;
}

}  // namespace tureen::trainer
