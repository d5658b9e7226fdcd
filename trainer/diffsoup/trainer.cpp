#include "trainer/diffsoup/trainer.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "trainer/common/random.hpp"
#include "trainer/diffsoup/backing.hpp"
#include "trainer/diffsoup/near_zone.hpp"
#include "trainer/diffsoup/split_choice.hpp"

namespace tureen::trainer {

namespace {

// Streams of random numbers, one per purpose.
constexpr std::uint64_t epoch_stream = std::uint64_t(1) << 32;
constexpr std::uint64_t split_stream = std::uint64_t(2) << 32;

/// Config::min_views is limited to 1 + training images / this number.
constexpr std::size_t images_a_view = 20;

/// Splits beyond the budget end at this multiple of the budget. Only about 25 edges of a fifth of
/// the image's height fit into a view, so 20 views stay far below it. It limits memory for tiny
/// thresholds.
constexpr std::size_t max_beyond = 8;

std::vector<std::uint32_t> shuffled(std::size_t count, Random random) {
  std::vector<std::uint32_t> order(count);
  std::iota(order.begin(), order.end(), 0u);
  for (std::size_t i = count; i > 1; --i) std::swap(order[i - 1], order[random.below(i)]);
  return order;
}

/// The moments for the resampled faces; those of new faces begin at zero.
Moments carried(const Moments& from, const Resampled& resampled) {
  Moments to;
  to.reset_faces(resampled.model);
  to.mlp_first = from.mlp_first;
  to.mlp_second = from.mlp_second;
  to.mlp_steps = from.mlp_steps;
  const std::size_t face_logits = resampled.model.texels() * channels;
  for (std::size_t face = 0; face < resampled.origin.size(); ++face) {
    if (resampled.is_new[face]) continue;
    const std::size_t old = resampled.origin[face];
    const auto copy = [&](const auto& source, auto& target, std::size_t each) {
      std::copy_n(source.begin() + std::ptrdiff_t(old * each), each,
                  target.begin() + std::ptrdiff_t(face * each));
    };
    copy(from.first, to.first, face_logits);
    copy(from.second, to.second, face_logits);
    copy(from.vertex_first, to.vertex_first, 3);
    copy(from.vertex_second, to.vertex_second, 3);
    copy(from.steps, to.steps, 1);
  }
  return to;
}

/// Changes a state's faces and tracks the origin of each.
class Renewal {
 public:
  /// `errors`: one per face of the current state.
  Renewal(TrainingState& state, std::vector<float> errors)
      : state_(state), errors_(std::move(errors)), origin_(state.model.faces()) {
    std::iota(origin_.begin(), origin_.end(), 0u);
  }

  void apply(Resampled&& resampled) {
    std::vector<std::uint32_t> from;
    from.reserve(resampled.origin.size());
    for (const std::uint32_t face : resampled.origin) from.push_back(origin_[face]);
    origin_ = std::move(from);
    state_.moments = carried(state_.moments, resampled);
    state_.model = std::move(resampled.model);
  }

  /// The errors of the current faces.
  std::vector<float> errors() const {
    std::vector<float> ordered;
    ordered.reserve(origin_.size());
    for (const std::uint32_t face : origin_) ordered.push_back(errors_[face]);
    return ordered;
  }

 private:
  TrainingState& state_;
  std::vector<float> errors_;
  std::vector<std::uint32_t> origin_;
};

Camera half_size(const Camera& camera) {
  Camera half = camera;
  half.width = std::max(1, camera.width / 2);
  half.height = std::max(1, camera.height / 2);
  const double x = double(half.width) / camera.width, y = double(half.height) / camera.height;
  half.fx *= x;
  half.cx *= x;
  half.fy *= y;
  half.cy *= y;
  return half;
}

}  // namespace

std::vector<std::uint32_t> batch_of(int step, int batch, std::size_t count, std::uint64_t seed) {
  assert(step >= 1 && batch >= 1 && count >= 1);
  const std::size_t size = std::size_t(batch), steps_an_epoch = (count + size - 1) / size;
  const std::size_t epoch = std::size_t(step - 1) / steps_an_epoch;
  const std::size_t begin = std::size_t(step - 1) % steps_an_epoch * size;
  const std::vector<std::uint32_t> order = shuffled(count, Random(seed, epoch_stream + epoch));
  return {order.begin() + std::ptrdiff_t(begin),
          order.begin() + std::ptrdiff_t(std::min(begin + size, count))};
}

Trainer::Trainer(const Config& config, std::span<const TrainingView> views,
                 std::unique_ptr<Backend> backend, TrainingState state)
    : config_(config), views_(views), backend_(std::move(backend)) {
  assert(config.max_level != automatic_level);
  quarantine(state);
  step_ = state.step;
  faces_ = state.model.faces();
  // A fit of the steps may have moved the lift; the levels tell whether it has been.
  is_lifted_ =
      step_ >= lift_step() || (config.minutes > 0 && state.model.max_level != config.coarse_level);
  backend_->upload(state);
}

StepReport Trainer::step() {
  assert(!done());
  ++step_;
  const double decay = std::pow(double(config_.decay), double(step_) / config_.steps);
  const StepReport report =
      backend_->step(batch_of(step_, config_.batch, views_.size(), config_.seed),
                     {.texture = float(config_.texture_rate * decay),
                      .mlp = float(config_.mlp_rate * decay),
                      .vertex = float(config_.vertex_rate * decay)});
  if (!is_lifted_ && step_ >= lift_step()) lift();
  if (resamples_now()) resample();
  for (const std::uint32_t next : batch_of(step_ + 1, config_.batch, views_.size(), config_.seed))
    expect(views_[next]);
  return report;
}

int Trainer::lift_step() const {
  return std::max(1, int(std::lround(double(config_.lift_at) * config_.steps)));
}

bool Trainer::resamples_now() const {
  const int last = last_resample_step();
  // A fit of the steps may have moved the last resampling, which meets the budget, to before now.
  if (step_ > last) return config_.minutes > 0 && faces_ != std::size_t(config_.triangles);
  return step_ == last || step_ % config_.resample_every == 0;
}

int Trainer::last_resample_step() const {
  // Rounded: 0.95f is a little less than 0.95.
  const auto until = int(std::lround(double(config_.resample_until) * config_.steps));
  // Short runs must meet the budget, too.
  return std::max(until / config_.resample_every * config_.resample_every, 1);
}

TrainingState Trainer::state() const {
  TrainingState state;
  backend_->download(state);
  return state;
}

void Trainer::lift() {
  TrainingState state = this->state();
  state.model = lifted(state.model, config_.min_level, config_.max_level,
                       config_.lift_keeps_opacity ? LiftedOpacity::kept : LiftedOpacity::reset);
  state.moments.reset_faces(state.model);
  backend_->upload(state);
  is_lifted_ = true;
}

void Trainer::resample() {
  TrainingState state = this->state();
  Renewal renewal(state, std::exchange(state.errors, {}));
  const std::size_t before = state.model.faces(), budget = std::size_t(config_.triangles);
  const bool last = step_ >= last_resample_step();
  const std::size_t backing = backing_faces(config_);
  const bool beyond = config_.split_beyond_budget && !config_.split_by_error;
  std::vector<Camera> cameras;
  for (const TrainingView& view : views_) cameras.push_back(half_size(view.camera));
  std::vector<std::uint64_t> pixels = evident_pixels(state.model, cameras);
  // If no face is visible yet, there is no data to choose by. The last resampling still has to meet
  // the budget.
  const auto of_surfaces = std::span(pixels).subspan(backing);
  const bool seen = std::ranges::any_of(of_surfaces, [](auto count) { return count > 0; });
  std::fill_n(pixels.begin(), backing, std::numeric_limits<std::uint64_t>::max());  // all stay
  if (!seen && !last) return;
  if (seen && !beyond) {  // published: only the budget removes faces of scenes
    renewal.apply(prune_unseen(state.model, pixels));
    std::erase(pixels, 0u);  // in the order of the faces that are left
  }
  last_resample_ = {.unseen = before - state.model.faces()};
  const bool renews = step_ < double(config_.turnover_until) * config_.steps;
  const std::size_t renewed = renews ? std::size_t(double(config_.turnover) * double(budget)) : 0;
  // At least one face besides the backing layer can be split.
  const std::size_t kept = std::max(budget - renewed, backing + 1);
  if (state.model.faces() > kept) {
    last_resample_.pruned = state.model.faces() - kept;
    renewal.apply(prune(state.model, pixels, kept));
  }
  const auto cut = [&](const std::vector<Split>& edges) {
    last_resample_.split += edges.size();
    if (!edges.empty())
      renewal.apply(
          split(state.model, edges,
                config_.resample_textures ? ChildTexture::resampled : ChildTexture::copied));
  };
  // Splits beyond the budget need a later pruning, so the last resampling has none.
  if (!(last && beyond))
    cut(config_.split_by_error ? greatest_errors(state.model, renewal.errors(), budget, backing)
                               : choose_splits(state, cameras));
  // Projected edges may all be short before the budget is met; the last resampling meets it.
  if (last) cut(longest_edges(state.model, budget, backing));
  renewal.apply(in_space_order(state.model, backing));
  if (config_.reset_moments) state.moments.reset_faces(state.model);
  faces_ = state.model.faces();
  backend_->upload(state);
}

/// The number of visible pixels of each face; 0 for a face that too few images show, or that lies
/// right in front of a camera.
std::vector<std::uint64_t> Trainer::evident_pixels(const Model& model,
                                                   std::span<const Camera> cameras) {
  // With few images, a place may be visible in only one of them.
  const int least = std::min(config_.min_views, 1 + int(cameras.size() / images_a_view));
  std::vector<std::uint64_t> pixels;
  if (least > 1) {
    pixels.resize(model.faces());
    std::vector<int> views(model.faces());
    for (const Camera& camera : cameras) {
      const std::vector<std::uint64_t> shown = backend_->visible_pixels({&camera, 1});
      for (std::size_t face = 0; face < shown.size(); ++face) {
        pixels[face] += shown[face];
        views[face] += shown[face] > 0;
      }
    }
    for (std::size_t face = 0; face < pixels.size(); ++face)
      if (views[face] < least) pixels[face] = 0;
  } else {
    pixels = backend_->visible_pixels(cameras);
  }
  if (config_.clear_near) {
    const std::vector<std::uint8_t> reaching = reaching_near_zone(model, cameras, config_.near);
    for (std::size_t face = 0; face < pixels.size(); ++face)
      if (reaching[face]) pixels[face] = 0;
  }
  return pixels;
}

std::vector<Split> Trainer::choose_splits(const TrainingState& state,
                                          std::span<const Camera> cameras) {
  const std::size_t triangles = std::size_t(config_.triangles);
  const std::size_t budget = config_.split_beyond_budget ? max_beyond * triangles : triangles;
  if (state.model.faces() == 0) return {};
  std::vector<Split> splits;
  if (config_.preset == Preset::scene) {
    // Scenes: the size in the image counts, not the size in the world.
    backend_->upload(state);
    const std::vector<std::uint32_t> chosen =
        shuffled(cameras.size(), Random(config_.seed, split_stream + std::uint64_t(step_)));
    const std::size_t count = std::min(cameras.size(), std::size_t(config_.split_views));
    std::vector<std::vector<std::uint8_t>> visible(count);
    std::vector<SplitView> views;
    for (std::size_t i = 0; i < count; ++i) {
      const Camera& camera = cameras[chosen[i]];
      for (const std::uint64_t pixels : backend_->visible_pixels({&camera, 1}))
        visible[i].push_back(pixels > 0);
      views.push_back({camera, visible[i]});
    }
    splits = longest_projected_edges(state.model, views,
                                     {.fraction = config_.split_fraction,
                                      .budget = budget,
                                      .first = backing_faces(config_),
                                      .near = config_.near});
  }
  if (splits.empty()) splits = longest_edges(state.model, triangles, backing_faces(config_));
  return splits;
}

}  // namespace tureen::trainer
