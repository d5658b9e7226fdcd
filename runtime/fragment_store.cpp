#include "runtime/fragment_store.hpp"

#include "runtime/gl/state.hpp"
#include "runtime/targets.hpp"
#include "soup/triangle_soup.hpp"

namespace tureen {

namespace {

const TargetFormat& feature_format(RenderPreset::FeatureStorage storage) {
  return storage == RenderPreset::FeatureStorage::rgba16f ? target_formats::rgba16f
                                                          : target_formats::rgba8;
}

}  // namespace

FragmentStore::FragmentStore(FeatureStorage storage, int width, int height, GLuint depth)
    : storage_(storage) {
  if (storage == FeatureStorage::visibility) {
    targets_[0] = make_target(target_formats::rg32ui, width, height);
    framebuffer_ = make_framebuffer({targets_[0].id()}, depth);
    return;
  }
  for (gl::Texture& target : targets_) target = make_target(feature_format(storage), width, height);
  framebuffer_ = make_framebuffer({targets_[0].id(), targets_[1].id()}, depth);
}

const char* FragmentStore::geometry_shader(FeatureStorage storage) {
  return storage == FeatureStorage::visibility ? "visibility.frag" : "features.frag";
}

const char* FragmentStore::shading_shader(FeatureStorage storage) {
  return storage == FeatureStorage::visibility ? "shading.frag" : "feature_shading.frag";
}

void FragmentStore::begin() const {
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.id());
  if (storage_ != FeatureStorage::visibility) return;
  const GLuint empty[4] = {no_face, 0, 0, 0};
  glClearBufferuiv(GL_COLOR, 0, empty);
}

void FragmentStore::bind(const gl::Program& program, int first_unit) const {
  static constexpr const char* names[2][2] = {{"visible", nullptr},
                                              {"stored_features0", "stored_features1"}};
  const auto& of_storage = names[storage_ == FeatureStorage::visibility ? 0 : 1];
  for (std::size_t i = 0; i < targets_.size() && of_storage[i]; ++i) {
    const int unit = first_unit + static_cast<int>(i);
    glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
    glBindTexture(GL_TEXTURE_2D, targets_[i].id());
    gl::use_texture_sampling(static_cast<unsigned>(unit));
    program.set(of_storage[i], unit);
  }
}

std::size_t FragmentStore::bytes(FeatureStorage storage, glm::ivec2 size) {
  return storage == FeatureStorage::visibility ? bytes_of(target_formats::rg32ui, size)
                                               : 2 * bytes_of(feature_format(storage), size);
}

GLuint FragmentStore::visibility_framebuffer() const {
  return storage_ == FeatureStorage::visibility ? framebuffer_.id() : 0;
}

}  // namespace tureen
