#include "runtime/splats/tile_pass.hpp"

#include <algorithm>
#include <cstring>
#include <limits>

#include "runtime/gl/state.hpp"
#include "splatting/tiles/composite.hpp"

namespace tureen {

namespace {

/// Emscripten's library lacks std::bit_cast.
float float_of(std::uint32_t bits) {
  float value;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}

}  // namespace

TilePass::TilePass(const gl::Capabilities& device, std::vector<const TiledSplats*> layers,
                   Quality::SplatOrder order)
    : layers_(std::move(layers)),
      order_(order == Quality::SplatOrder::exact ? splatting::BlendOrder::along_rays
                                                 : splatting::BlendOrder::centers),
      renderer_([this](std::size_t count, const std::function<void(std::size_t)>& body) {
        pool_.run(count, body);
      }),
      blended_(device.api, {target_formats::rgba32f}),
      depth_bits_(full_screen_program({.file = "depth_probe.frag"}, device.api)) {}

void TilePass::resize(const FrameTarget& target) {
  size_ = target.size();
  has_texture_ = false;
  views_.clear();
  bits_ = {};
  bits_framebuffer_ = {};
}

void TilePass::draw(const Frame& frame, FrameTarget& target) {
  views_.clear();
  const auto pixel_area = static_cast<float>(frame.samples_per_pixel * frame.samples_per_pixel);
  for (const TiledSplats* each : layers_) {
    const FrameCamera& camera = frame.layers[each->layer];
    if (!camera.visible) continue;
    views_.push_back(
        {each->splats.get(),
         splatting::image_view(camera.camera, camera.eye, camera.range.near, each->profile,
                               frame.input.whole.value_or(frame.input.camera)),
         camera.scale});
    // In samples.
    views_.back().view.dilation *= pixel_area;
    views_.back().view.screen_variance *= pixel_area;
  }
  if (views_.empty()) return;
  read_depths(frame, target);
  if (target.has_color())
    draw_over_colors(target);
  else
    draw_over_background(target);
}

/// OpenGL ES can read back only colours, so a shader writes the depths as bits.
void TilePass::read_depths(const Frame& frame, const FrameTarget& target) {
  depths_.clear();
  if (!target.has_depth()) return;
  const glm::ivec2 size = target.size();
  if (!bits_) {
    bits_ = make_target(target_formats::r32ui, size.x, size.y);
    bits_framebuffer_ = make_framebuffer({bits_.id()});
  }
  glDisable(GL_DEPTH_TEST);
  glBindFramebuffer(GL_FRAMEBUFFER, bits_framebuffer_.id());
  depth_bits_.use();
  depth_bits_.set_texture("depth", 0, target.depth_texture());
  depth_bits_.set("pixel", glm::ivec2(0));
  full_screen_.draw(depth_bits_);
  const std::vector<std::uint32_t> bits = read_visible_slots(bits_framebuffer_.id(), size);
  const DepthStorage storage =
      target.reversed_depth() ? DepthStorage::reversed_float : DepthStorage::fixed_24;
  depths_.resize(bits.size());
  constexpr std::size_t pixels_a_task = 1 << 14;
  pool_.run((bits.size() + pixels_a_task - 1) / pixels_a_task, [&](std::size_t task) {
    const std::size_t end = std::min((task + 1) * pixels_a_task, bits.size());
    for (std::size_t i = task * pixels_a_task; i < end; ++i)
      depths_[i] = float(distance_of(double(float_of(bits[i])), frame.range, storage)
                             .value_or(std::numeric_limits<double>::infinity()));
  });
}

template <class Act>
void TilePass::draw_rows(const Act& act) {
  const auto row_floats = 4 * std::size_t(size_.x);
  renderer_.draw(
      views_, depths_,
      [&](int first_row, std::span<const float> rgba) {
        for (auto row = std::size_t(first_row); !rgba.empty(); ++row) {
          act(row, rgba.first(row_floats));
          rgba = rgba.subspan(row_floats);
        }
      },
      order_);
}

void TilePass::draw_over_colors(FrameTarget& target) {
  if (!has_texture_) blended_.resize(size_);
  has_texture_ = true;
  const auto row_floats = 4 * std::size_t(size_.x);
  blended_upside_down_.resize(row_floats * std::size_t(size_.y));
  draw_rows([&](std::size_t row, std::span<const float> rgba) {
    std::copy(rgba.begin(), rgba.end(),
              &blended_upside_down_[(std::size_t(size_.y) - 1 - row) * row_floats]);
  });
  gl::use_plain_pixel_transfer();
  glBindTexture(GL_TEXTURE_2D, blended_.texture());
  glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, size_.x, size_.y, GL_RGBA, GL_FLOAT,
                  blended_upside_down_.data());
  blended_.composite_over(target);
}

/// Composites on the processor: on software devices, that takes a fraction of the time of drawing.
void TilePass::draw_over_background(FrameTarget& target) {
  const auto width = std::size_t(size_.x), height = std::size_t(size_.y);
  colors_upside_down_.resize(width * height);
  draw_rows([&](std::size_t row, std::span<const float> rgba) {
    splatting::composite(rgba, target.background(),
                         std::span(colors_upside_down_).subspan((height - 1 - row) * width, width));
  });
  target.overwrite_color();
  gl::use_plain_pixel_transfer();
  glBindTexture(GL_TEXTURE_2D, target.color_texture());
  glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, size_.x, size_.y, GL_RGBA, GL_UNSIGNED_BYTE,
                  colors_upside_down_.data());
}

/// Draws them again: frames do not keep them.
std::vector<glm::vec4> TilePass::read_blended() {
  const auto width = std::size_t(size_.x);
  std::vector<glm::vec4> result(width * std::size_t(size_.y), glm::vec4(0));
  if (views_.empty()) return result;
  draw_rows([&](std::size_t row, std::span<const float> rgba) {
    std::memcpy(&result[row * width], rgba.data(), rgba.size_bytes());
  });
  return result;
}

std::size_t TilePass::target_bytes() const {
  return (has_texture_ ? blended_.bytes() : 0) +
         (bits_ ? bytes_of(target_formats::r32ui, size_) : 0);
}

void TilePass::leave_context() {
  blended_.leave_context();
  has_texture_ = false;
  full_screen_.leave_context();
  bits_ = {};
  bits_framebuffer_ = {};
}

}  // namespace tureen
