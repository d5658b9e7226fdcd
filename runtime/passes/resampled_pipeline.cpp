#include "runtime/passes/resampled_pipeline.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "base/error.hpp"
#include "runtime/gl/program.hpp"
#include "runtime/gl/state.hpp"
#include "runtime/passes/shader_source.hpp"
#include "runtime/passes/targets.hpp"

namespace tureen {

namespace {

/// Draws a frame with another pipeline at another size, and filters it to the size of the image.
class ResampledPipeline : public Pipeline {
 public:
  ResampledPipeline(std::unique_ptr<Pipeline> pipeline, const ImageLimit& limit, const char* filter,
                    const std::map<std::string, std::string>& constants)
      : pipeline_(std::move(pipeline)),
        limit_(limit),
        filter_(assemble({.file = "full_screen.vert"}, limit.api),
                assemble({.file = filter, .constants = constants}, limit.api)) {}

  void resize(int width, int height) final {
    const glm::ivec2 size = size_to_draw({width, height});
    if (std::max(size.x, size.y) > limit_.max_side)
      throw DeviceLimitError("an image of " + std::to_string(width) + "x" + std::to_string(height) +
                             " needs " + std::to_string(size.x) + "x" + std::to_string(size.y) +
                             " samples, but this device draws at most " +
                             std::to_string(limit_.max_side) + " a side");
    pipeline_->resize(size.x, size.y);
    size_ = {width, height};
    drawn_size_ = size;
    color_ = make_target(target_formats::rgba8, width, height);
    color_framebuffer_ = make_framebuffer({color_.id()}, 0);
  }

  void draw(const FrameCamera& frame, const glm::vec4& background) final {
    pipeline_->draw({resampled(frame.camera, drawn_size_.x, drawn_size_.y), frame.eye, frame.range},
                    background);
    const gl::TimedPass pass(timer_, "filter");
    gl::use_plain_rasterisation(size_.x, size_.y);
    glDisable(GL_DEPTH_TEST);
    glBindFramebuffer(GL_FRAMEBUFFER, color_framebuffer_.id());
    filter_.use();
    glActiveTexture(GL_TEXTURE0);
    glBindTexture(GL_TEXTURE_2D, pipeline_->color_texture());
    gl::use_texture_sampling(0);
    filter_.set("samples", 0);
    filter_.set("background_depth", 0.0f);
    filter_.set("samples_per_pixel", glm::vec2(drawn_size_) / glm::vec2(size_));
    nothing_.bind();
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glEnable(GL_DEPTH_TEST);
    gl::check("resampled draw");
  }

  GLuint color_framebuffer() const final { return color_framebuffer_.id(); }
  GLuint color_texture() const final { return color_.id(); }
  GLuint visibility_framebuffer() const final { return pipeline_->visibility_framebuffer(); }
  GLuint depth_texture() const final { return pipeline_->depth_texture(); }
  glm::ivec2 sample_size() const final { return pipeline_->sample_size(); }
  std::size_t device_bytes() const final { return pipeline_->device_bytes(); }
  std::size_t target_bytes() const final {
    return pipeline_->target_bytes() + bytes_of(target_formats::rgba8, size_);
  }
  void leave_context() final {
    nothing_.forget();
    color_framebuffer_ = {};
    pipeline_->leave_context();
  }
  void time_passes(gl::PassTimer* timer) final {
    Pipeline::time_passes(timer);
    pipeline_->time_passes(timer);
  }

 protected:
  virtual glm::ivec2 size_to_draw(glm::ivec2 size) const = 0;

 private:
  std::unique_ptr<Pipeline> pipeline_;
  ImageLimit limit_;
  gl::Program filter_;
  gl::LocalVertexArray nothing_;
  glm::ivec2 size_{0}, drawn_size_{0};
  gl::Texture color_;
  gl::Framebuffer color_framebuffer_;
};

class SupersampledPipeline final : public ResampledPipeline {
 public:
  SupersampledPipeline(std::unique_ptr<Pipeline> pipeline, int n, const ImageLimit& limit)
      : ResampledPipeline(std::move(pipeline), limit, "box_filter.frag",
                          {{"SAMPLES_PER_AXIS", std::to_string(n)}}),
        n_(n) {}

 private:
  glm::ivec2 size_to_draw(glm::ivec2 size) const override { return n_ * size; }

  int n_;
};

class UpscaledPipeline final : public ResampledPipeline {
 public:
  UpscaledPipeline(std::unique_ptr<Pipeline> pipeline, double scale, const ImageLimit& limit)
      : ResampledPipeline(std::move(pipeline), limit, "upscale.frag", {}), scale_(scale) {}

 private:
  glm::ivec2 size_to_draw(glm::ivec2 size) const override {
    return {scaled_size(size.x, scale_), scaled_size(size.y, scale_)};
  }

  double scale_;
};

}  // namespace

int scaled_size(int size, double scale) {
  return std::max(1, static_cast<int>(std::lround(size * scale)));
}

std::unique_ptr<Pipeline> make_supersampled(std::unique_ptr<Pipeline> pipeline, int n,
                                            const ImageLimit& limit) {
  return std::make_unique<SupersampledPipeline>(std::move(pipeline), n, limit);
}

std::unique_ptr<Pipeline> make_upscaled(std::unique_ptr<Pipeline> pipeline, double scale,
                                        const ImageLimit& limit) {
  return std::make_unique<UpscaledPipeline>(std::move(pipeline), scale, limit);
}

}  // namespace tureen
