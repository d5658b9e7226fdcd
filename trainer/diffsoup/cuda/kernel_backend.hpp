// A training step as a sequence of kernels on a Machine: a GPU
// (trainer/common/cuda/cuda_machine.cuh), or a processor in tests (tests/trainer/host_machine.hpp).
// All data stays in the machine's memory between upload() and download(); a step returns only its
// report.
//
// A Machine has memory, and runs kernels in the order of their launches:
//
//   std::string description() const;
//   void* allocate(std::size_t bytes);      // throws DeviceLimitError if the memory is full
//   void release(void* memory);
//   void clear(void* memory, std::size_t bytes);
//   void upload(void* to, const void* from, std::size_t bytes);
//   void download(void* to, const void* from, std::size_t bytes);  // waits for earlier launches
//   template <class Kernel> void launch(const Kernel&, std::size_t blocks);
//   unsigned resident_blocks() const;       // blocks that use it fully, for kernels with any
//   number void mark(int number);                  // records the time after earlier launches
//   double seconds(int from, int to);       // time between marks, after a download
//
// Two runs give the same bits on the same kind of machine.
#pragma once

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "trainer/diffsoup/backing.hpp"
#include "trainer/diffsoup/cpu/batch_image.hpp"
#include "trainer/diffsoup/cuda/face_kernels.hpp"
#include "trainer/diffsoup/cuda/loss_kernels.hpp"
#include "trainer/diffsoup/cuda/shading_kernels.hpp"

namespace tureen::trainer::cuda {

/// An array in a machine's memory. It does not free memory when it shrinks.
template <class Machine, class T>
class Buffer {
 public:
  explicit Buffer(Machine& machine) : machine_(machine) {}
  Buffer(const Buffer&) = delete;
  Buffer& operator=(const Buffer&) = delete;
  ~Buffer() { machine_.release(data_); }

  T* data() const { return data_; }
  std::size_t size() const { return size_; }

  /// Loses the contents if the array grows beyond its allocated memory.
  void resize(std::size_t size) {
    size_ = size;
    if (size <= capacity_) return;
    machine_.release(std::exchange(data_, nullptr));
    capacity_ = 0;
    data_ = static_cast<T*>(machine_.allocate(size * sizeof(T)));
    capacity_ = size;
  }
  void clear() {
    if (size_) machine_.clear(data_, size_ * sizeof(T));
  }
  /// Resizes to `values` and copies them. U is T or a struct of T.
  template <class U>
  void upload(const std::vector<U>& values) {
    static_assert(sizeof(U) % sizeof(T) == 0);
    // NOLINTNEXTLINE(bugprone-sizeof-expression): pointers are ordinary values here
    resize(values.size() * (sizeof(U) / sizeof(T)));
    if (size_) machine_.upload(data_, values.data(), size_ * sizeof(T));
  }
  void upload(const T* values, std::size_t first, std::size_t count) {
    if (count) machine_.upload(data_ + first, values, count * sizeof(T));
  }
  /// `values` must have the array's size.
  template <class U>
  void download(std::vector<U>& values) const {
    if (size_) machine_.download(values.data(), data_, size_ * sizeof(T));
  }
  void download(T* values) const { machine_.download(values, data_, size_ * sizeof(T)); }

 private:
  Machine& machine_;
  T* data_ = nullptr;
  std::size_t size_ = 0, capacity_ = 0;
};

template <class Machine>
class KernelBackend final : public Backend {
 public:
  /// Copies the views' images into the machine's memory.
  KernelBackend(std::span<const TrainingView> views, const Config& config);

  std::string description() const override { return machine_.description(); }
  void upload(const TrainingState& state) override;
  void download(TrainingState& state) const override;
  StepReport step(std::span<const std::uint32_t> views, const Rates& rates) override;
  StageTimes take_times() override;
  std::vector<std::uint64_t> visible_pixels(std::span<const Camera> cameras) override;
  std::vector<float> render(const Camera& camera) override;

 private:
  template <class T>
  using Array = Buffer<Machine, T>;

  DeviceImage image_of(const Camera& camera) const;
  void set_images(std::vector<DeviceImage> images);
  void find_visible(Masking masking);
  void shade();
  void take_loss();
  void shade_backward();
  void step_faces(const Rates& rates);
  StepReport read_report();
  DeviceModel model() const;
  Textures textures() const;
  static std::size_t blocks(std::size_t count, unsigned threads) {
    return (count + threads - 1) / threads;
  }
  /// Blocks of ShadeBackward. Each writes mlp_parameters sums; one block of StepNetwork adds them.
  static constexpr unsigned network_blocks = 512;

  std::span<const TrainingView> views_;
  Config config_;
  mutable Machine machine_;

  // Data of the views, one view after another.
  std::vector<std::size_t> first_pixel_;
  Array<std::uint8_t> targets_{machine_}, ignored_{machine_};
  Array<std::uint16_t> baseline_{machine_};

  // The state. state_ holds the members that are not arrays.
  TrainingState state_;
  Array<float> positions_{machine_}, logits_{machine_}, mlp_{machine_};
  Array<float> first_{machine_}, second_{machine_};
  Array<float> vertex_first_{machine_}, vertex_second_{machine_};
  Array<float> mlp_first_{machine_}, mlp_second_{machine_}, errors_{machine_};
  Array<std::uint32_t> steps_{machine_}, mlp_steps_{machine_};

  // Data computed from the state.
  Array<lattice::Coordinates> coordinates_{machine_};
  Array<float> work_{machine_}, values_{machine_}, alpha_{machine_};
  Array<Fixed> texture_sums_{machine_}, corner_sums_{machine_}, error_sums_{machine_};
  Array<unsigned> flags_{machine_};

  // Data of a batch.
  std::vector<DeviceImage> batch_images_;
  DeviceBatch batch_{};
  unsigned tiles_ = 0;
  Array<DeviceImage> images_{machine_};
  Array<kernels::ProjectedFace> projected_{machine_};
  Array<std::uint64_t> first_piece_{machine_};
  Array<VisibleKey> keys_{machine_};
  Array<float> color_{machine_}, by_color_{machine_}, windows_{machine_}, advantage_{machine_};
  Array<float> error_{machine_};
  Array<float> by_features_{machine_}, by_mlp_{machine_};
  Array<ImageSums> sums_{machine_};  // one per image, and a last one for the parameters
  Array<unsigned long long> counts_{machine_}, fragments_{machine_};
  StageTimes times_;
};

template <class Machine>
KernelBackend<Machine>::KernelBackend(std::span<const TrainingView> views, const Config& config)
    : views_(views), config_(config) {
  first_pixel_.push_back(0);
  bool any_ignored = false;
  for (const TrainingView& view : views) {
    first_pixel_.push_back(first_pixel_.back() +
                           std::size_t(view.camera.width) * std::size_t(view.camera.height));
    any_ignored |= has_ignored(view);
  }
  fragments_.resize(1);
  fragments_.clear();
  targets_.resize(3 * first_pixel_.back());
  if (any_ignored) ignored_.resize(first_pixel_.back());
  for (std::size_t i = 0; i < views.size(); ++i) {
    const TrainingView view = loaded(views[i]);
    targets_.upload(view.target.data(), 3 * first_pixel_[i], view.target.size());
    ignored_.upload(view.ignored.data(), first_pixel_[i], view.ignored.size());
  }
}

template <class Machine>
void KernelBackend<Machine>::upload(const TrainingState& state) {
  state_.model.min_level = state.model.min_level;
  state_.model.max_level = state.model.max_level;
  state_.model.origin = state.model.origin;
  state_.step = state.step;
  state_.non_finite = state.non_finite;

  positions_.upload(state.model.positions);
  logits_.upload(state.model.logits);
  first_.upload(state.moments.first);
  second_.upload(state.moments.second);
  vertex_first_.upload(state.moments.vertex_first);
  vertex_second_.upload(state.moments.vertex_second);
  steps_.upload(state.moments.steps);
  const auto upload_network = [](Array<float>& to, const MlpParameters& from) {
    to.resize(from.size());
    to.upload(from.data(), 0, from.size());
  };
  upload_network(mlp_, state.model.mlp);
  upload_network(mlp_first_, state.moments.mlp_first);
  upload_network(mlp_second_, state.moments.mlp_second);
  mlp_steps_.upload(std::vector<std::uint32_t>{state.moments.mlp_steps});
  if (config_.baseline) {
    baseline_.resize(first_pixel_.back());
    baseline_.clear();
    baseline_.upload(state.baseline.data(), 0,
                     std::min(state.baseline.size(), first_pixel_.back()));
  }

  const std::size_t faces = state.model.faces();
  const std::size_t fine_texels = lattice::texel_count(state.model.max_level);
  std::vector<lattice::Coordinates> coordinates;
  for (std::uint32_t i = 0; i < fine_texels; ++i)
    coordinates.push_back(lattice::texel_coordinates(i));
  coordinates_.upload(coordinates);
  work_.resize(logits_.size());
  values_.resize(faces * fine_texels * channels);
  alpha_.resize(faces * fine_texels);
  texture_sums_.resize(values_.size());
  corner_sums_.resize(9 * faces);
  flags_.resize(faces);
  error_sums_.resize(faces);
  texture_sums_.clear();
  corner_sums_.clear();
  flags_.clear();
  error_sums_.clear();
  errors_.resize(faces);
  errors_.clear();
  errors_.upload(state.errors.data(), 0, state.errors.size());
  machine_.launch(RefreshTextures{.textures = textures()}, faces);
}

template <class Machine>
void KernelBackend<Machine>::download(TrainingState& state) const {
  state = state_;
  const std::size_t faces = flags_.size();
  state.model.positions.resize(3 * faces);
  state.model.logits.resize(logits_.size());
  state.moments.reset_faces(state.model);
  positions_.download(state.model.positions);
  logits_.download(state.model.logits);
  first_.download(state.moments.first);
  second_.download(state.moments.second);
  vertex_first_.download(state.moments.vertex_first);
  vertex_second_.download(state.moments.vertex_second);
  steps_.download(state.moments.steps);
  mlp_.download(state.model.mlp.data());
  mlp_first_.download(state.moments.mlp_first.data());
  mlp_second_.download(state.moments.mlp_second.data());
  mlp_steps_.download(&state.moments.mlp_steps);
  state.errors.resize(faces);
  errors_.download(state.errors);
  if (config_.baseline) {
    state.baseline.resize(baseline_.size());
    baseline_.download(state.baseline);
  }
}

template <class Machine>
DeviceModel KernelBackend<Machine>::model() const {
  return {.faces = flags_.size(),
          .min_level = state_.model.min_level,
          .max_level = state_.model.max_level,
          .positions = positions_.data(),
          .values = values_.data(),
          .alpha = alpha_.data(),
          .mlp = mlp_.data(),
          .background = {config_.background[0], config_.background[1], config_.background[2]}};
}

template <class Machine>
Textures KernelBackend<Machine>::textures() const {
  return {.min_level = state_.model.min_level,
          .max_level = state_.model.max_level,
          .coordinates = coordinates_.data(),
          .logits = logits_.data(),
          .work = work_.data(),
          .values = values_.data(),
          .alpha = alpha_.data()};
}

template <class Machine>
DeviceImage KernelBackend<Machine>::image_of(const Camera& camera) const {
  DeviceImage image{};
  image.view = view_of(camera, state_.model.origin, config_.near, config_.far);
  return image;
}

/// Lays out a batch. `images` must have their view and the data of their photograph.
template <class Machine>
void KernelBackend<Machine>::set_images(std::vector<DeviceImage> images) {
  batch_ = {.images = nullptr, .count = unsigned(images.size()), .pixels = 0};
  tiles_ = 0;
  for (DeviceImage& image : images) {
    image.first_pixel = batch_.pixels;
    image.first_tile = tiles_;
    image.tiles_x = unsigned(image.view.width + tile_width - 1) / tile_width;
    batch_.pixels += image.pixels();
    tiles_ += image.tiles_x * (unsigned(image.view.height + tile_height - 1) / tile_height);
  }
  images_.upload(images);
  batch_.images = images_.data();
  batch_images_ = std::move(images);
  projected_.resize(batch_.count * flags_.size());
  first_piece_.resize(projected_.size() + 1);
  keys_.resize(batch_.pixels);
}

template <class Machine>
void KernelBackend<Machine>::find_visible(Masking masking) {
  const Projections projections{projected_.data(), first_piece_.data()};
  keys_.clear();
  machine_.launch(ProjectFaces{.batch = batch_, .model = model(), .out = projections},
                  blocks(projected_.size(), ProjectFaces::threads));
  machine_.launch(SumPieces{.first_piece = first_piece_.data(), .count = projected_.size()}, 1);
  machine_.launch(FindVisible{.batch = batch_,
                              .model = model(),
                              .projections = projections,
                              .masking = masking,
                              .keys = keys_.data(),
                              .fragments = fragments_.data()},
                  machine_.resident_blocks());
}

template <class Machine>
void KernelBackend<Machine>::shade() {
  color_.resize(3 * batch_.pixels);
  machine_.launch(Shade{.batch = batch_,
                        .model = model(),
                        .projected = projected_.data(),
                        .keys = keys_.data(),
                        .color = color_.data()},
                  blocks(batch_.pixels, Shade::threads));
}

template <class Machine>
StepReport KernelBackend<Machine>::step(std::span<const std::uint32_t> views, const Rates& rates) {
  const auto step_number = std::uint32_t(state_.step + 1);
  std::vector<DeviceImage> images;
  for (const std::uint32_t view : views) {
    DeviceImage& image = images.emplace_back(image_of(views_[view].camera));
    image.draw_key = kernels::draw_key(config_.seed, step_number, view);
    image.target = targets_.data() + 3 * first_pixel_[view];
    if (has_ignored(views_[view])) image.ignored = ignored_.data() + first_pixel_[view];
    if (config_.baseline) image.baseline = baseline_.data() + first_pixel_[view];
  }
  set_images(std::move(images));
  sums_.resize(views.size() + 1);
  sums_.clear();

  machine_.mark(0);
  find_visible(Masking::stochastic);
  machine_.mark(1);
  shade();
  machine_.mark(2);
  take_loss();
  machine_.mark(3);
  shade_backward();
  machine_.mark(4);
  step_faces(rates);
  machine_.mark(5);
  state_.step = int(step_number);
  return read_report();
}

template <class Machine>
void KernelBackend<Machine>::take_loss() {
  windows_.resize(9 * batch_.pixels);
  by_color_.resize(color_.size());
  advantage_.resize(batch_.pixels);
  error_.resize(batch_.pixels);
  machine_.launch(CompareWindows{.batch = batch_,
                                 .color = color_.data(),
                                 .windows = windows_.data(),
                                 .sums = sums_.data()},
                  tiles_);
  const float share = 1.0f / float(batch_.count);
  machine_.launch(TakeLoss{.batch = batch_,
                           .weights = {.l1 = config_.l1_weight * share,
                                       .ssim = config_.ssim_weight * share,
                                       .opacity = config_.opacity_l1_weight * share,
                                       .baseline_rate = config_.baseline_rate},
                           .color = color_.data(),
                           .windows = windows_.data(),
                           .keys = keys_.data(),
                           .by_color = by_color_.data(),
                           .advantage = advantage_.data(),
                           .error = error_.data(),
                           .sums = sums_.data()},
                  tiles_);
}

template <class Machine>
void KernelBackend<Machine>::shade_backward() {
  // Gradients are means over the batch. Scaled to one pixel, they fit the range of a half.
  const float half_scale = config_.gradient_precision == GradientPrecision::float16
                               ? 3.0f * float(batch_images_.front().pixels()) * float(batch_.count)
                               : 0.0f;
  by_features_.resize(batch_.pixels * channels);
  by_mlp_.resize(std::size_t(network_blocks) * mlp_parameters);
  machine_.launch(ShadeBackward{.batch = batch_,
                                .model = model(),
                                .projected = projected_.data(),
                                .keys = keys_.data(),
                                .by_color = by_color_.data(),
                                .blocks = network_blocks,
                                .by_features = by_features_.data(),
                                .half_scale = half_scale,
                                .by_mlp = by_mlp_.data()},
                  network_blocks);
}

template <class Machine>
void KernelBackend<Machine>::step_faces(const Rates& rates) {
  const FaceSums sums{texture_sums_.data(), corner_sums_.data(), flags_.data(), error_sums_.data()};
  unsigned long long* non_finite = &(sums_.data() + batch_.count)->non_finite;
  machine_.launch(GatherFaces{.batch = batch_,
                              .model = model(),
                              .projections = {projected_.data(), first_piece_.data()},
                              .keys = keys_.data(),
                              .color = color_.data(),
                              .by_color = by_color_.data(),
                              .by_features = by_features_.data(),
                              .advantage = advantage_.data(),
                              .error = error_.data(),
                              .slide = config_.texture_slide,
                              .sums = sums},
                  machine_.resident_blocks());
  machine_.launch(StepFaces{.textures = textures(),
                            .sums = sums,
                            .positions = positions_.data(),
                            .first = first_.data(),
                            .second = second_.data(),
                            .vertex_first = vertex_first_.data(),
                            .vertex_second = vertex_second_.data(),
                            .steps = steps_.data(),
                            .errors = errors_.data(),
                            .texture_rate = rates.texture,
                            .vertex_rate = rates.vertex,
                            .beta1 = config_.beta1,
                            .beta2 = config_.beta2,
                            .epsilon = config_.epsilon,
                            .fixed_faces = backing_faces(config_),
                            .dense_updates = config_.dense_updates,
                            .non_finite = non_finite},
                  flags_.size());
  machine_.launch(StepNetwork{.by_mlp = by_mlp_.data(),
                              .blocks = network_blocks,
                              .mlp = mlp_.data(),
                              .first = mlp_first_.data(),
                              .second = mlp_second_.data(),
                              .steps = mlp_steps_.data(),
                              .rate = rates.mlp,
                              .beta1 = config_.beta1,
                              .beta2 = config_.beta2,
                              .epsilon = config_.epsilon,
                              .non_finite = non_finite},
                  1);
}

template <class Machine>
StepReport KernelBackend<Machine>::read_report() {
  std::vector<ImageSums> sums(sums_.size());
  sums_.download(sums);
  const auto value = [](Fixed sum) {
    return double(static_cast<long long>(sum)) / double(loss_scale);
  };
  const double share = 1.0 / double(batch_.count);
  StepReport report;
  report.non_finite = sums.back().non_finite;
  for (std::size_t i = 0; i < batch_images_.size(); ++i) {
    const kernels::View& view = batch_images_[i].view;
    const double columns = view.width - ssim_reach, rows = view.height - ssim_reach;
    const double l1 = value(sums[i].l1) / (3.0 * view.width * view.height);
    const double dissimilar =
        columns > 0 && rows > 0 ? value(sums[i].dissimilarity) / (3 * columns * rows) : 0;
    report.l1 += l1 * share;
    report.ssim += (1 - dissimilar) * share;
    report.loss +=
        share * (double(config_.l1_weight) * l1 + double(config_.ssim_weight) * dissimilar / 2);
    report.mse += value(sums[i].squared) / (3.0 * double(batch_.pixels));
    report.non_finite += sums[i].non_finite;
    times_.shaded_pixels += sums[i].shaded;
  }
  state_.non_finite += report.non_finite;
  times_.visibility += machine_.seconds(0, 1);
  times_.shading += machine_.seconds(1, 2);
  times_.loss += machine_.seconds(2, 3);
  times_.shading_backward += machine_.seconds(3, 4);
  times_.faces += machine_.seconds(4, 5);
  times_.pixels += batch_.pixels;
  ++times_.steps;
  return report;
}

template <class Machine>
StageTimes KernelBackend<Machine>::take_times() {
  unsigned long long fragments = 0;
  fragments_.download(&fragments);
  fragments_.clear();
  times_.fragments = fragments;
  return std::exchange(times_, {});
}

template <class Machine>
std::vector<std::uint64_t> KernelBackend<Machine>::visible_pixels(std::span<const Camera> cameras) {
  counts_.resize(flags_.size());
  counts_.clear();
  constexpr std::size_t at_once = 8;  // enough images to hide the cost of a launch
  for (std::size_t begin = 0; begin < cameras.size(); begin += at_once) {
    std::vector<DeviceImage> images;
    for (const Camera& camera : cameras.subspan(begin, std::min(at_once, cameras.size() - begin)))
      images.push_back(image_of(camera));
    set_images(std::move(images));
    find_visible(Masking::threshold);
    machine_.launch(
        CountVisible{.keys = keys_.data(), .pixels = batch_.pixels, .counts = counts_.data()},
        blocks(batch_.pixels, CountVisible::threads));
  }
  std::vector<unsigned long long> counts(counts_.size());
  counts_.download(counts);
  return {counts.begin(), counts.end()};
}

template <class Machine>
std::vector<float> KernelBackend<Machine>::render(const Camera& camera) {
  set_images({image_of(camera)});
  find_visible(Masking::threshold);
  shade();
  std::vector<float> color(color_.size());
  color_.download(color);
  return color;
}

}  // namespace tureen::trainer::cuda
