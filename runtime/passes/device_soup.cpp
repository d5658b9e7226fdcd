#include "runtime/passes/device_soup.hpp"

#include <utility>

#include "runtime/gl/api.hpp"
#include "runtime/passes/shader_source.hpp"

#ifdef __EMSCRIPTEN__
#include <webgl/webgl1_ext.h>
#endif

namespace tureen {

namespace {

/// Triangles from the bound vertex array: counts[i] vertices beginning at first[i], run by run, in
/// one call if the context supports it.
void draw_runs(const gl::Capabilities& capabilities, std::span<const std::int32_t> first,
               std::span<const std::int32_t> counts) {
  const auto runs = static_cast<GLsizei>(first.size());
  if (!capabilities.multi_draw) {
    for (std::size_t i = 0; i < first.size(); ++i) glDrawArrays(GL_TRIANGLES, first[i], counts[i]);
    return;
  }
#ifdef __EMSCRIPTEN__
  glMultiDrawArraysWEBGL(GL_TRIANGLES, first.data(), counts.data(), runs);
#else
  glMultiDrawArrays(GL_TRIANGLES, first.data(), counts.data(), runs);
#endif
}

}  // namespace

DeviceAppearance::DeviceAppearance(AppearanceSource source)
    : glsl(std::move(source.glsl)),
      constants(std::move(source.constants)),
      mlp(std::move(source.mlp)) {
  for (AppearanceSource::Sampler& sampler : source.samplers) {
    samplers.push_back({std::move(sampler.name), TexelStore(source.layout, sampler.source)});
    sampler.source.fill = nullptr;  // frees its data after the upload
  }
}

std::size_t DeviceAppearance::device_bytes() const {
  std::size_t total = 0;
  for (const Sampler& sampler : samplers) total += sampler.store.device_bytes();
  return total;
}

void DeviceAppearance::bind(const gl::Program& program) const {
  int unit = 0;
  for (const Sampler& sampler : samplers)
    program.set_texture(sampler.name.c_str(), unit++, sampler.store.texture(), GL_TEXTURE_2D_ARRAY);
  if (!mlp.weights.empty()) {
    program.set("mlp_weights", std::span<const glm::mat4>(mlp.weights));
    program.set("mlp_biases", std::span<const glm::vec4>(mlp.biases));
  }
}

DeviceSoup::DeviceSoup(const gl::Capabilities& device, AppearanceSource appearance,
                       const GeometrySource& geometry, const SoupPlan& plan)
    : plan_(plan), device_(device), appearance_(std::move(appearance)), geometry_(geometry) {
  if (plan.drops_small_triangles) {
    covered_.emplace(geometry);
    covered_vertices_ = gl::Buffer::create();
    glGetIntegerv(GL_SUBPIXEL_BITS, &subpixel_bits_);
  }
  gl::check("DeviceSoup");
}

std::string DeviceSoup::source(const char* file, const Constants& constants,
                               const Constants& generated) const {
  ShaderSource source{.file = file,
                      .constants = appearance_.constants,
                      .generated = {{"appearance.glsl", appearance_.glsl}}};
  source.constants.insert(constants.begin(), constants.end());
  if (slots_.layered) source.constants["LAYERED"] = "1";
  source.generated.insert(generated.begin(), generated.end());
  return assemble(source, device_.api);
}

gl::Program DeviceSoup::face_program(const char* fragment, const Constants& constants) const {
  return gl::Program(assemble({.file = "geometry.vert"}, device_.api), source(fragment, constants));
}

void DeviceSoup::set_first_slot(const gl::Program& program) const {
  program.set("first_slot", static_cast<int>(slots_.first_slot));
}

void DeviceSoup::draw_faces(const gl::Program& opaque, const gl::Program& cut_out,
                            const FrameCamera& camera, const FrameTarget& target) {
  if (frames_until_retry_ > 0) --frames_until_retry_;
  const auto& clusters = plan_.clusters;
  std::size_t opaque_clusters = 0;
  while (opaque_clusters < clusters.size() &&
         clusters[opaque_clusters].first_slot < plan_.opaque_count)
    ++opaque_clusters;
  const std::span all(clusters);
  if (opaque_clusters > 0) draw_clusters(opaque, all.first(opaque_clusters), camera, target);
  if (opaque_clusters < clusters.size())
    draw_clusters(cut_out, all.subspan(opaque_clusters), camera, target);
}

void DeviceSoup::draw_clusters(const gl::Program& program, std::span<const Cluster> clusters,
                               const FrameCamera& camera, const FrameTarget& target) {
  program.use();
  appearance_.bind(program);
  geometry_.bind();
  Geometry::set_camera(program, camera, target.clip_from_view(camera.camera, camera.range));
  set_rays(program, camera.camera);
  set_first_slot(program);
  order_.sort(clusters, glm::vec3(camera.eye), glm::vec3(forward_of(camera.camera)));
  const auto first = order_.first_vertices(), count = order_.vertex_counts();
  if (covered_ && frames_until_retry_ == 0 && covered_->begin_frame(camera, subpixel_bits_)) {
    draw_covered(first, count);
    return;
  }
  draw_runs(device_, first, count);
}

/// Draws those faces of the runs that may be visible.
void DeviceSoup::draw_covered(std::span<const std::int32_t> first,
                              std::span<const std::int32_t> count) {
  vertices_.clear();
  for (std::size_t i = 0; i < first.size(); ++i) covered_->append(first[i], count[i], vertices_);
  std::size_t all = 0;
  for (const std::int32_t each : count) all += static_cast<std::size_t>(each);
  if (static_cast<double>(vertices_.size()) > worthwhile * static_cast<double>(all))
    frames_until_retry_ = retry_interval;
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, covered_vertices_.id());
  glBufferData(GL_ELEMENT_ARRAY_BUFFER,
               static_cast<GLsizeiptr>(vertices_.size() * sizeof vertices_[0]), vertices_.data(),
               GL_STREAM_DRAW);
  glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(vertices_.size()), GL_UNSIGNED_INT, nullptr);
}

std::size_t DeviceSoup::device_bytes() const {
  return appearance_.device_bytes() + geometry_.device_bytes() + (covered_ ? covered_->bytes() : 0);
}

}  // namespace tureen
