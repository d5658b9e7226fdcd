#include "runtime/splats/splat_pass.hpp"

#include <algorithm>
#include <glm/geometric.hpp>

#include "runtime/gl/state.hpp"
#include "runtime/passes/shader_source.hpp"
#include "runtime/passes/targets.hpp"

namespace tureen {

namespace {

constexpr TargetFormat single_format{GL_RGBA32F, GL_RGBA, GL_FLOAT, 16};
constexpr TargetFormat half_format{GL_RGBA16F, GL_RGBA, GL_HALF_FLOAT, 8};
constexpr int order_columns = DeviceSplats::order_columns;
constexpr TargetFormat order_format{GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, 4};

/// The view depth in world units.
SplatsInView in_view(const DeviceSplats& splats, const FrameCamera& camera) {
  const glm::dmat3 view_from_layer(camera.camera.view_from_world);
  const glm::dvec3 axis = -camera.scale * glm::transpose(view_from_layer)[2];
  SplatsInView view{
      .centers = splats.centers(), .axis = axis, .offset = glm::dot(axis, camera.eye)};
  for (const Bounds& box : splats.chunks()) {
    const glm::dvec3 half = 0.5 * (glm::dvec3(box.high) - glm::dvec3(box.low));
    const double farthest =
        glm::dot(axis, box.centre() - camera.eye) + glm::dot(glm::abs(axis), half);
    view.behind.push_back(farthest < 0);  // of the eye, and so of the near plane
  }
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

SplatPass::SplatPass(const gl::Capabilities& device,
                     std::span<const std::unique_ptr<DeviceSplats>> layers, Precision precision)
    : precision_(precision),
      resolve_(assemble({.file = "full_screen.vert"}, device.api),
               assemble({.file = "splat_resolve.frag"}, device.api)) {
  for (const std::unique_ptr<DeviceSplats>& layer : layers)
    if (layer) layers_.push_back(layer.get());
}

SplatPass::~SplatPass() { stop_sorting(); }

void SplatPass::sort_with(SplatSorter* sorter) {
  stop_sorting();
  sorter_ = sorter;
}

void SplatPass::stop_sorting() {
  if (sorter_) sorter_->forget();
  sorting_.reset();
}

const TargetFormat& SplatPass::blended_format() const {
  return precision_ == Precision::single ? single_format : half_format;
}

void SplatPass::resize(const FrameTarget& target) {
  size_ = target.size();
  blended_ = make_target(blended_format(), size_.x, size_.y);
  behind_ = make_target(target_formats::rgba8, size_.x, size_.y);
  blended_framebuffer_ = make_framebuffer({blended_.id()}, target.depth_attachment());
  depthless_framebuffer_ = make_framebuffer({blended_.id()});
  behind_framebuffer_ = make_framebuffer({behind_.id()});
}

void SplatPass::draw(const Frame& frame, FrameTarget& target) {
  for (DeviceSplats* layer : layers_)
    if (frame.layers[layer->layer()].visible) layer->project(frame);
  update_order(frame);
  blend(frame, target);
  resolve(target);
}

void SplatPass::update_order(const Frame& frame) {
  std::vector<SplatsInView> views;
  for (const DeviceSplats* layer : layers_) {
    const FrameCamera& camera = frame.layers[layer->layer()];
    views.push_back(in_view(*layer, camera));
    if (!camera.visible) views.back() = {};
  }
  in_order_ = order_texture_ && serves(ordered_, views);
  if (in_order_) return;
  if (sorter_ && frame.may_use_earlier_order && has_many(views) && has_splats_of(ordered_, views))
    continue_sorting(views);
  else
    sort_now(std::move(views));
}

void SplatPass::sort_now(std::vector<SplatsInView> views) {
  stop_sorting();
  order_.sort(views);
  ordered_ = std::move(views);
  in_order_ = true;
  upload_order();
}

void SplatPass::continue_sorting(const std::vector<SplatsInView>& views) {
  if (sorting_ && sorter_->take(order_)) {
    ordered_ = std::move(*sorting_);
    sorting_.reset();
    in_order_ = serves(ordered_, views);
    upload_order();
  }
  if (in_order_ || sorting_) return;
  sorting_ = views;
  sorter_->begin(views);
}

void SplatPass::upload_order() {
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

void SplatPass::blend(const Frame& frame, FrameTarget& target) {
  gl::use_plain_rasterisation(size_.x, size_.y);
  glBindFramebuffer(GL_FRAMEBUFFER, blended_framebuffer_.id());
  target.use_depth();
  constexpr GLfloat nothing[4] = {0, 0, 0, 0};
  glClearBufferfv(GL_COLOR, 0, nothing);
  glDepthMask(GL_FALSE);
  glEnable(GL_BLEND);
  glBlendEquation(GL_FUNC_ADD);
  glBlendFunc(GL_ONE_MINUS_DST_ALPHA, GL_ONE);
  const DeviceSplats* begun = nullptr;
  for (const SplatRun& run : order_.runs()) {
    DeviceSplats& layer = *layers_[run.layer];
    if (begun != &layer) {
      glBindFramebuffer(GL_FRAMEBUFFER, layer.tests_depth() ? depthless_framebuffer_.id()
                                                            : blended_framebuffer_.id());
      layer.begin_runs(frame, target, order_texture_.id());
    }
    begun = &layer;
    layer.draw_run(run.first, run.count);
  }
  glDisable(GL_BLEND);
}

void SplatPass::resolve(FrameTarget& target) {
  target.draw_color();  // clears the colours if no pass has drawn any
  blit_color(target.color_framebuffer(), behind_framebuffer_.id(), size_);
  target.overwrite_color();
  resolve_.use();
  resolve_.set_texture("splats", 0, blended_.id());
  resolve_.set_texture("behind", 1, behind_.id());
  full_screen_.draw(resolve_);
}

std::vector<glm::vec4> SplatPass::read_blended() const {
  const auto width = static_cast<std::size_t>(size_.x), height = static_cast<std::size_t>(size_.y);
  std::vector<glm::vec4> pixels(width * height);
  glBindFramebuffer(GL_READ_FRAMEBUFFER, blended_framebuffer_.id());
  glReadBuffer(GL_COLOR_ATTACHMENT0);
  gl::use_plain_pixel_transfer();
  glReadPixels(0, 0, size_.x, size_.y, GL_RGBA, GL_FLOAT, pixels.data());
  gl::throw_if_lost();
  for (std::size_t y = 0; y < height / 2; ++y)
    std::swap_ranges(&pixels[y * width], &pixels[y * width] + width,
                     &pixels[(height - 1 - y) * width]);
  return pixels;
}

std::size_t SplatPass::device_bytes() const {
  return order_texture_ ? std::size_t(order_rows_) * order_columns * std::size_t(order_format.bytes)
                        : 0;
}

std::size_t SplatPass::target_bytes() const {
  return bytes_of(blended_format(), size_) + bytes_of(target_formats::rgba8, size_);
}

void SplatPass::leave_context() {
  full_screen_.leave_context();
  blended_framebuffer_ = {};
  depthless_framebuffer_ = {};
  behind_framebuffer_ = {};
}

}  // namespace tureen
