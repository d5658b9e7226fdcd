// Single stages of a training step: an image as prepared by the backend, and the gradient that
// steps a face.
#pragma once

#include <cstddef>
#include <glm/vec3.hpp>
#include <vector>

#include "trainer/diffsoup/cpu/batch_image.hpp"
#include "trainer/diffsoup/cpu/corner_gradient.hpp"
#include "trainer/diffsoup/cpu/face_stage.hpp"
#include "trainer/diffsoup/cpu/visibility.hpp"
#include "trainer/diffsoup/levels.hpp"

namespace tureen::trainer::test {

/// A camera at the origin that looks along -z, with square pixels and the principal point in the
/// middle. At distance z, a unit measures focal / z pixels.
inline Camera axis_camera(int width, int height, double focal) {
  return {.name = {},
          .width = width,
          .height = height,
          .fx = focal,
          .fy = focal,
          .cx = width / 2.0,
          .cy = height / 2.0};
}

inline BatchImage make_image(const Camera& camera, double near = 0.01, double far = 100) {
  BatchImage image;
  image.view = view_of(camera, glm::dvec3(0.0), near, far);
  image.tiles_x = (camera.width + tile_side - 1) / tile_side;
  image.tiles_y = (camera.height + tile_side - 1) / tile_side;
  image.visible.resize(image.pixels());
  image.color.resize(3 * image.pixels());
  image.by_color.resize(3 * image.pixels());
  image.loss.resize(image.pixels());
  image.features.resize(image.pixels());
  return image;
}

/// Faces of one lattice level, their moments and their textures.
struct Faces {
  Model model;
  Moments moments;
  Pyramid pyramid;
  TextureStore store;
  std::vector<float> errors;

  /// Three positions per face; all logits are 0 except alpha's, which are `alpha_logit`.
  explicit Faces(std::vector<glm::vec3> positions, float alpha_logit = 200.0f, int level = 0)
      : pyramid(level, level) {
    model.min_level = model.max_level = level;
    model.positions = std::move(positions);
    model.logits.assign(model.faces() * model.texels() * channels, 0.0f);
    for (std::size_t i = alpha_channel; i < model.logits.size(); i += channels)
      model.logits[i] = alpha_logit;
    refresh();
  }

  /// Call after changes of the logits.
  void refresh() {
    moments.reset_faces(model);
    store.values.resize(model.faces() * pyramid.fine_texels());
    store.alpha.resize(model.faces() * pyramid.fine_texels());
    FaceScratch scratch(pyramid);
    for (std::size_t face = 0; face < model.faces(); ++face)
      refresh_texture(pyramid, model, face, store, scratch);
  }

  void find(BatchImage& image, Masking masking) const {
    bin_faces(image, model);
    for (std::size_t tile = 0; tile < image.tiles(); ++tile)
      find_visible(image, tile, store.alpha.data(), model.max_level, masking);
    list_faces(image);
  }

  /// Gathers the face's gradient from images whose `features` hold dL/dfeature and whose `loss`
  /// holds the score's factor. It is stored in the moments of a first step: with beta1 = 0 the
  /// first moment is the gradient. Rates are 0, so nothing moves.
  unsigned gather(std::span<BatchImage> images, std::size_t face) {
    for (BatchImage& image : images)
      for (std::size_t tile = 0; tile < image.tiles(); ++tile) {
        find_corner_gradients(image, tile, 0.5f);
        collect_fragments(image, tile);
      }
    moments.reset_faces(model);
    errors.assign(model.faces(), 0.0f);
    const FaceStep step{.images = images,
                        .pyramid = &pyramid,
                        .model = &model,
                        .moments = &moments,
                        .store = &store,
                        .errors = &errors,
                        .texture_rate = 0,
                        .vertex_rate = 0,
                        .beta1 = 0,
                        .beta2 = 0.999f,
                        .epsilon = 1e-8f,
                        .dense_updates = false};
    FaceScratch scratch(pyramid);
    return step_face(step, face, scratch);
  }

  /// After gather(): dL/dposition of a corner.
  glm::dvec3 by_corner(std::size_t face, int corner) const {
    return glm::dvec3(moments.vertex_first[3 * face + std::size_t(corner)]);
  }

  /// After gather(): dL/dlogit.
  double by_logit(std::size_t face, std::size_t texel, int channel) const {
    return moments.first[(face * model.texels() + texel) * channels + std::size_t(channel)];
  }
};

}  // namespace tureen::trainer::test
