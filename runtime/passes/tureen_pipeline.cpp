// Tureen's pipeline. A geometry pass stores the visible face of each pixel, then a shading pass
// colours the covered pixels. A forward plan writes colours in a single pass.
#include <optional>
#include <utility>
#include <vector>

#include "runtime/gl/draw.hpp"
#include "runtime/gl/state.hpp"
#include "runtime/passes/covered_faces.hpp"
#include "runtime/passes/device_appearance.hpp"
#include "runtime/passes/fragment_store.hpp"
#include "runtime/passes/geometry.hpp"
#include "runtime/passes/pipeline.hpp"
#include "runtime/passes/shader_source.hpp"
#include "runtime/passes/shading_pass.hpp"
#include "runtime/passes/targets.hpp"

namespace tureen {

namespace {

class TureenPipeline final : public Pipeline {
 public:
  TureenPipeline(const gl::Capabilities& capabilities, AppearanceSource appearance,
                 const GeometrySource& geometry, const RenderPlan& plan)
      : plan_(plan),
        device_(capabilities),
        appearance_(std::move(appearance)),
        geometry_(geometry) {
    if (plan.drops_small_triangles) {
      covered_.emplace(geometry);
      covered_vertices_ = gl::Buffer::create();
      glGetIntegerv(GL_SUBPIXEL_BITS, &subpixel_bits_);
    }
    const char* fragment = plan.site == ShadingSite::forward    ? "forward.frag"
                           : plan.site == ShadingSite::deferred ? "visibility.frag"
                                                                : "nothing.frag";
    const std::size_t cut_out = plan.faces.size() - plan.opaque_count;
    if (plan.opaque_count > 0) opaque_ = program(fragment, {{"ALPHA_TEST", "0"}});
    if (cut_out > 0) cut_out_ = program(fragment, {{"ALPHA_TEST", "1"}});
    if (plan.site == ShadingSite::deferred) shading_.emplace(plan, shading_sources());
    gl::check("TureenPipeline");
  }

  void resize(int width, int height) override {
    width_ = width;
    height_ = height;
    const TargetFormat& depth = depth_format();
    color_ = plan_.shading_stage == ShadingStage::fragment
                 ? make_target(target_formats::rgba8, width, height)
                 : make_image_target(target_formats::rgba8, width, height);
    depth_ = make_target(depth, width, height);
    color_framebuffer_ = make_framebuffer({color_.id()}, depth_.id());
    if (plan_.site == ShadingSite::deferred) store_ = FragmentStore(width, height, depth_.id());
    gl::check("resize");
  }

  void draw(const FrameCamera& frame, const glm::vec4& background) override {
    if (search_rests_ > 0) --search_rests_;
    gl::use_plain_rasterisation(width_, height_);
    if (plan_.reversed_depth) gl::use_zero_to_one_depth(device_.api, true);
    if (plan_.site == ShadingSite::deferred) {
      draw_store(frame);
      shading_->draw({.camera = frame,
                      .background = background,
                      .store = store_,
                      .appearance = appearance_,
                      .color_framebuffer = color_framebuffer_.id(),
                      .color_texture = color_.id(),
                      .width = width_,
                      .height = height_},
                     timer_);
    } else {
      draw_forward(frame, background);
    }
    if (plan_.reversed_depth) gl::use_zero_to_one_depth(device_.api, false);
    gl::check("draw");
  }

  void leave_context() override {
    geometry_.leave_context();
    if (shading_) shading_->leave_context();
    color_framebuffer_ = {};
    store_ = {};
  }
  GLuint color_framebuffer() const override { return color_framebuffer_.id(); }
  GLuint color_texture() const override { return color_.id(); }
  GLuint depth_texture() const override { return depth_.id(); }
  glm::ivec2 sample_size() const override { return {width_, height_}; }
  GLuint visibility_framebuffer() const override { return store_.framebuffer(); }
  std::size_t device_bytes() const override {
    return appearance_.device_bytes() + geometry_.device_bytes() +
           (covered_ ? covered_->bytes() : 0);
  }
  std::size_t target_bytes() const override {
    const std::size_t color = bytes_of(target_formats::rgba8, sample_size()),
                      depth = bytes_of(depth_format(), sample_size());
    return color + depth +
           (plan_.site == ShadingSite::deferred ? FragmentStore::bytes(sample_size()) : 0);
  }

 private:
  using Constants = std::map<std::string, std::string>;

  const TargetFormat& depth_format() const {
    return plan_.reversed_depth ? target_formats::depth32f : target_formats::depth24;
  }

  gl::Program program(const char* fragment, const Constants& constants) const {
    return gl::Program(assemble({.file = "geometry.vert"}, device_.api),
                       with_appearance(fragment, constants));
  }

  /// Complete GLSL for a file that reads the appearance.
  std::string with_appearance(const char* file, const Constants& constants) const {
    ShaderSource source{.file = file,
                        .constants = appearance_.constants,
                        .generated = {{"appearance.glsl", appearance_.glsl}}};
    source.constants.insert(constants.begin(), constants.end());
    return assemble(source, device_.api);
  }

  ShadingSources shading_sources() const {
    const Constants constants{
        {"NO_FACE", "0xffffffffu"},
        {"DEPTH_REJECTS_BACKGROUND", plan_.depth_rejects_background ? "1" : "0"},
        {"GROUP_SIDE", std::to_string(shading_group_side)}};
    ShadingSources sources{.vertex = assemble({.file = "full_screen.vert"}, device_.api),
                           .fragment = {},
                           .compute = {}};
    if (plan_.shading_stage == ShadingStage::compute)
      sources.compute = with_appearance("shading.comp", constants);
    else
      sources.fragment = with_appearance("shading.frag", constants);
    return sources;
  }

  void clear_depth() const {
    const float far = plan_.reversed_depth ? 0.0f : 1.0f;
    glClearBufferfv(GL_DEPTH, 0, &far);
    glDepthFunc(plan_.reversed_depth ? GL_GREATER : GL_LESS);
  }

  void draw_store(const FrameCamera& frame) {
    const gl::TimedPass pass(timer_, "visibility");
    store_.begin();
    clear_depth();
    draw_geometry(frame);
  }

  /// The only pass of a forward plan, and of ShadingSite::nowhere, which keeps the background's
  /// colour.
  void draw_forward(const FrameCamera& frame, const glm::vec4& background) {
    const gl::TimedPass pass(timer_, "forward");
    glBindFramebuffer(GL_FRAMEBUFFER, color_framebuffer_.id());
    glClearBufferfv(GL_COLOR, 0, &background[0]);
    if (plan_.site == ShadingSite::nowhere) glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
    clear_depth();
    draw_geometry(frame);
  }

  /// Opaque faces first: they are cheap and hide the others.
  void draw_geometry(const FrameCamera& frame) {
    const auto& clusters = plan_.clusters;
    std::size_t opaque_clusters = 0;
    while (opaque_clusters < clusters.size() &&
           clusters[opaque_clusters].first_slot < plan_.opaque_count)
      ++opaque_clusters;
    const std::span all(clusters);
    if (opaque_clusters > 0) draw_clusters(opaque_, all.first(opaque_clusters), frame);
    if (opaque_clusters < clusters.size())
      draw_clusters(cut_out_, all.subspan(opaque_clusters), frame);
  }

  void draw_clusters(const gl::Program& program, std::span<const Cluster> clusters,
                     const FrameCamera& frame) {
    program.use();
    appearance_.bind(program);
    geometry_.bind();
    Geometry::set_camera(program, frame,
                         plan_.reversed_depth
                             ? clip_from_view_reversed(frame.camera, frame.range.near)
                             : clip_from_view(frame.camera, frame.range.near, frame.range.far));
    set_rays(program, frame.camera);
    const glm::dvec3 forward = -frame.camera.world_from_view_rotation()[2];
    order_.sort(clusters, glm::vec3(frame.eye), glm::vec3(forward));
    const auto first = order_.first_vertices(), count = order_.vertex_counts();
    if (covered_ && search_rests_ == 0 && covered_->begin_frame(frame, subpixel_bits_)) {
      draw_covered(first, count);
      return;
    }
    gl::draw_runs(device_, first, count);
  }

  /// Draws those faces of the runs that may be visible.
  void draw_covered(std::span<const std::int32_t> first, std::span<const std::int32_t> count) {
    vertices_.clear();
    for (std::size_t i = 0; i < first.size(); ++i) covered_->append(first[i], count[i], vertices_);
    std::size_t all = 0;
    for (const std::int32_t each : count) all += static_cast<std::size_t>(each);
    if (static_cast<double>(vertices_.size()) > worthwhile * static_cast<double>(all))
      search_rests_ = rested_frames;
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, covered_vertices_.id());
    glBufferData(GL_ELEMENT_ARRAY_BUFFER,
                 static_cast<GLsizeiptr>(vertices_.size() * sizeof vertices_[0]), vertices_.data(),
                 GL_STREAM_DRAW);
    glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(vertices_.size()), GL_UNSIGNED_INT, nullptr);
  }

  const RenderPlan& plan_;
  gl::Capabilities device_;
  DeviceAppearance appearance_;
  Geometry geometry_;
  gl::Program opaque_, cut_out_;
  FrontToBack order_;
  std::optional<CoveredFaces> covered_;  // if small triangles are culled
  gl::Buffer covered_vertices_;
  std::vector<std::uint32_t> vertices_;  // for the last draw_covered()
  int subpixel_bits_ = 0;
  /// Culling costs time for every face. If more than this fraction of the faces remains, the next
  /// frames draw all faces; the image is the same.
  static constexpr double worthwhile = 0.7;
  static constexpr int rested_frames = 30;  // the cost falls to a thirtieth
  int search_rests_ = 0;                    // frames
  int width_ = 0, height_ = 0;
  gl::Texture depth_, color_;
  gl::Framebuffer color_framebuffer_;
  std::optional<ShadingPass> shading_;  // if the plan is deferred
  FragmentStore store_;                 // likewise
};

}  // namespace

std::unique_ptr<Pipeline> make_tureen_pipeline(const gl::Capabilities& capabilities,
                                               AppearanceSource appearance,
                                               const GeometrySource& geometry,
                                               const RenderPlan& plan) {
  return std::make_unique<TureenPipeline>(capabilities, std::move(appearance), geometry, plan);
}

}  // namespace tureen
