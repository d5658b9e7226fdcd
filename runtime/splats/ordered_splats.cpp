#include "runtime/splats/ordered_splats.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "runtime/gl/state.hpp"

namespace tureen {

namespace {

constexpr int order_columns = DeviceSplats::order_columns;
constexpr TargetFormat order_format = target_formats::r32ui;

/// The smallest cosine between the viewing axis and the rays of the image with EWA's margin around
/// it, which large splats may cross.
double cosine_of_image(const Camera& camera) {
  const glm::dvec2 size(camera.width, camera.height), middle(camera.cx, camera.cy);
  const glm::dvec2 farthest =
      (glm::max(middle, size - middle) + ewa_margin * size) / glm::dvec2(camera.fx, camera.fy);
  return 1 / std::sqrt(1 + glm::dot(farthest, farthest));
}

/// Sets SplatsInView::behind and outside.
void find_chunks_to_skip(std::span<const Bounds> chunks, const FrameCamera& camera,
                         SplatsInView& view) {
  const double cosine = cosine_of_image(camera.camera) * glm::length(view.axis);
  for (const Bounds& box : chunks) {
    const glm::dvec3 low(box.low), high(box.high);
    const double farthest = glm::dot(view.axis, box.center() - camera.eye) +
                            glm::dot(glm::abs(view.axis), 0.5 * (high - low));
    const double distance = glm::distance(camera.eye, glm::clamp(camera.eye, low, high));
    view.behind.push_back(farthest < 0);  // of the eye, and so of the near plane
    view.outside.push_back(farthest < 0 || farthest < cosine * distance);
  }
}

SplatsInView in_view(const DeviceSplats& splats, const FrameCamera& camera, float fraction) {
  SplatsInView view = in_view(splats.centers(), camera);
  view.fraction = fraction;
  find_chunks_to_skip(splats.chunks(), camera, view);
  return view;
}

/// Sorting fewer splats takes less than a millisecond.
constexpr std::size_t many_splats = 100'000;

bool has_many(std::span<const SplatsInView> views) {
  std::size_t splats = 0;
  for (const SplatsInView& view : views) splats += view.centers.size();
  return splats >= many_splats;
}

}  // namespace

SplatsInView in_view(std::span<const glm::vec3> centers, const FrameCamera& camera) {
  const glm::dmat3 view_from_layer(camera.camera.view_from_world);
  const glm::dvec3 axis = -camera.scale * glm::transpose(view_from_layer)[2];
  return {.centers = centers, .axis = axis, .offset = glm::dot(axis, camera.eye)};
}

SplatFramebuffers make_splat_framebuffers(std::initializer_list<GLuint> colors,
                                          const FrameTarget& target) {
  return {make_framebuffer(colors, target.depth_attachment()), make_framebuffer(colors)};
}

OrderedSplats::OrderedSplats(std::span<DeviceSplats* const> layers, float fraction)
    : layers_(layers.begin(), layers.end()), fraction_(fraction) {}

OrderedSplats::~OrderedSplats() { stop_sorting(); }

void OrderedSplats::sort_with(SplatSorter* sorter) {
  stop_sorting();
  sorter_ = sorter;
}

void OrderedSplats::stop_sorting() {
  if (sorter_) sorter_->forget();
  sorting_.reset();
}

void OrderedSplats::prepare(const Frame& frame, float color_unit) {
  std::vector<SplatsInView> views;
  for (DeviceSplats* layer : layers_) {
    const FrameCamera& camera = frame.layers[layer->layer()];
    if (camera.visible) layer->project(frame, color_unit);
    views.push_back(camera.visible ? in_view(*layer, camera, fraction_) : SplatsInView{});
  }
  in_order_ = order_texture_ && serves(ordered_, views);
  if (in_order_) return;
  const bool may_be_earlier = sorter_ && frame.may_use_earlier_order && has_many(views);
  if (may_be_earlier) take_order(views);
  if (in_order_) return;
  // The camera may have turned to splats that were behind it when the sort began, or too far.
  if (may_be_earlier && has_visible_splats_of(ordered_, views) && lags_little(ordered_, views))
    continue_sorting(std::move(views));
  else
    sort_now(std::move(views));
}

void OrderedSplats::sort_now(std::vector<SplatsInView> views) {
  stop_sorting();
  order_.sort(views);
  ordered_ = std::move(views);
  in_order_ = true;
  upload_order();
}

/// Takes the sorter's order, if it is complete.
void OrderedSplats::take_order(const std::vector<SplatsInView>& views) {
  if (!sorting_ || !sorter_->take(order_)) return;
  ordered_ = std::move(*sorting_);
  sorting_.reset();
  in_order_ = serves(ordered_, views);
  upload_order();
}

void OrderedSplats::continue_sorting(std::vector<SplatsInView> views) {
  if (sorting_) return;
  sorting_ = views;
  sorter_->begin(std::move(views));
}

void OrderedSplats::upload_order() {
  const std::span<const std::uint32_t> splats = order_.splats();
  const auto columns = static_cast<std::size_t>(order_columns);
  const auto full_rows = static_cast<int>(splats.size() / columns);
  const auto rest = static_cast<int>(splats.size() % columns);
  const int rows = std::max(1, full_rows + (rest > 0 ? 1 : 0));
  if (!order_texture_ || rows > order_rows_) {
    order_texture_ = make_target(order_format, order_columns, rows);
    order_rows_ = rows;
  }
  gl::use_plain_pixel_transfer();
  glBindTexture(GL_TEXTURE_2D, order_texture_.id());
  const auto upload = [&](int row, int width, int height) {
    if (width > 0 && height > 0)
      glTexSubImage2D(GL_TEXTURE_2D, 0, 0, row, width, height, order_format.format,
                      order_format.type, splats.data() + static_cast<std::size_t>(row) * columns);
  };
  upload(0, order_columns, full_rows);
  upload(full_rows, rest, 1);
}

void OrderedSplats::begin(FrameTarget& target, const SplatFramebuffers& framebuffers) const {
  gl::use_plain_rasterisation(target.size().x, target.size().y);
  const bool tests_depth =
      target.has_depth() || std::any_of(layers_.begin(), layers_.end(),
                                        [](DeviceSplats* layer) { return layer->tests_depth(); });
  glBindFramebuffer(GL_FRAMEBUFFER,
                    (tests_depth ? framebuffers.with_depth : framebuffers.without_depth).id());
  if (tests_depth)
    target.use_depth();
  else
    glDisable(GL_DEPTH_TEST);
  glDepthMask(GL_FALSE);
}

void OrderedSplats::begin(FrameTarget& target, const SplatFramebuffers& framebuffers,
                          const glm::vec4& value) const {
  begin(target, framebuffers);
  glClearBufferfv(GL_COLOR, 0, &value[0]);
}

void OrderedSplats::draw(const Frame& frame, FrameTarget& target,
                         const SplatFramebuffers& framebuffers, const SplatDrawing& drawing,
                         Range range) {
  const DeviceSplats* begun = nullptr;
  for (const SplatRun& run : order_.runs()) {
    const std::uint32_t begin = std::max(run.first, range.begin);
    const std::uint32_t end = std::min(run.first + run.count, range.end);
    if (begin >= end) continue;
    DeviceSplats& layer = *layers_[run.layer];
    if (begun != &layer) {
      const gl::Framebuffer& framebuffer = layer.tests_depth() || !target.has_depth()
                                               ? framebuffers.without_depth
                                               : framebuffers.with_depth;
      glBindFramebuffer(GL_FRAMEBUFFER, framebuffer.id());
      layer.begin_runs(frame, target, order_texture_.id(), drawing);
    }
    begun = &layer;
    layer.draw_run(begin, end - begin);
  }
}

bool OrderedSplats::may_skip_hidden() const {
  return std::all_of(layers_.begin(), layers_.end(),
                     [](DeviceSplats* layer) { return layer->may_skip_hidden(); });
}

float OrderedSplats::largest_color() const {
  float largest = 1;
  for (const DeviceSplats* layer : layers_) largest = std::max(largest, layer->largest_color());
  return largest;
}

float OrderedSplats::min_alpha() const {
  float least = 1;
  for (const DeviceSplats* layer : layers_) least = std::min(least, layer->profile().min_alpha);
  return least;
}

std::size_t OrderedSplats::device_bytes() const {
  return order_texture_ ? std::size_t(order_rows_) * order_columns * order_format.bytes : 0;
}

}  // namespace tureen
