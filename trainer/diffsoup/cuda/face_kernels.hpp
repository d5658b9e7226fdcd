// The gradients of faces from images, and their steps. On the CPU, a face gathers what
// tiles listed for it (trainer/diffsoup/cpu/face_stage.hpp). Here, pieces of faces add to sums in
// fixed point. Then one block per face steps it, refreshes its texture and clears the sums for the
// next step.
#pragma once

#include "trainer/common/kernels/adam.hpp"
#include "trainer/common/kernels/edge_gradient.hpp"
#include "trainer/common/kernels/score.hpp"
#include "trainer/diffsoup/cuda/visibility_kernels.hpp"
#include "trainer/diffsoup/kernels/texture.hpp"

namespace tureen::trainer::cuda {

// Bits of FaceSums::flags.
inline constexpr unsigned touched_flag = 1, bad_texture_flag = 2, bad_corners_flag = 4;

/// Sums of the gradients; all are zero between steps.
struct FaceSums {
  Fixed* texture;   // [face][fine texel][channels]: by the features, and by the logit of alpha
  Fixed* corners;   // [face][3][3]: by the positions, world axes
  unsigned* flags;  // [face]
  Fixed* errors;    // [face]: sum of |C - G| over its visible pixels and their channels
};

/// Sums the gradients from score, features and edges. Any number of blocks.
struct GatherFaces {
  static constexpr unsigned threads = 128;
  using Shared = Nothing;
  using Local = Nothing;
  DeviceBatch batch;
  DeviceModel model;
  Projections projections;
  const VisibleKey* keys;
  const float* color;        // as Shade::color
  const float* by_color;     // as Shade::color
  const float* by_features;  // [pixel][channels]
  const float* advantage;    // [pixel]
  const float* error;        // [pixel]
  float slide;               // scale of the texture slide, kernels/edge_gradient.hpp
  FaceSums sums;

  TUREEN_HOST_DEVICE unsigned phases() const { return 1; }
  template <class Atomics>
  TUREEN_HOST_DEVICE void run(unsigned, const Thread& at, Shared&, Local&) const {
    for_each_own_piece(batch, projections, model.faces, at, threads,
                       [&](const Piece& piece, const kernels::ProjectedFace& face) {
                         gather<Atomics>(piece, face, at);
                       });
  }

  template <class Atomics>
  TUREEN_HOST_DEVICE void gather(const Piece& piece, const kernels::ProjectedFace& face,
                                 const Thread& at) const {
    const DeviceImage& image = batch.images[piece.image];
    unsigned flags = 0;
    float errors = 0;
    float corners[3][3] = {};  // right, down, forward
    for_each_own_fragment(image.view, piece, face, at, [&](const kernels::Fragment& fragment) {
      const std::size_t pixel =
          std::size_t(fragment.y) * std::size_t(image.view.width) + std::size_t(fragment.x);
      const VisibleKey key = keys[image.first_pixel + pixel];
      const bool won = key != 0 && face_of(key) == piece.face;
      // Behind the winner nothing depends on this face.
      if (visible_key(fragment.inverse_depth, piece.face) < key) return;
      flags |= touched_flag;
      const auto texels = lattice::footprint(model.max_level, fragment.b0, fragment.b1);
      if (!add_score<Atomics>(piece.face, image.first_pixel + pixel, texels, won))
        flags |= bad_texture_flag;
      if (!won) return;
      errors += error[image.first_pixel + pixel];
      if (!add_features<Atomics>(piece.face, image.first_pixel + pixel, texels))
        flags |= bad_texture_flag;
      gather_edges(image, piece, face, fragment, corners);
    });
    if (flags && !add_corners<Atomics>(image.view, piece.face, corners)) flags |= bad_corners_flag;
    if (errors > 0) Atomics::add(sums.errors[piece.face], to_fixed(errors, loss_scale));
    if (flags & ~Atomics::load(sums.flags[piece.face]))
      Atomics::set_bits(sums.flags[piece.face], flags);
  }

  /// Returns false if it skipped a value that is not finite; so do the functions below.
  template <class Atomics>
  TUREEN_HOST_DEVICE bool add_score(std::uint32_t face, std::size_t pixel,
                                    const lattice::Footprint<float>& at, bool won) const {
    const float* alpha = model.alpha + face * model.fine_texels();
    Fixed* out = sums.texture + face * model.fine_texels() * channels;
    const float a = lattice::interpolated(at, alpha);
    const auto role = won ? kernels::FragmentRole::winner : kernels::FragmentRole::in_front;
    bool good = true;
    for (int j = 0; j < 3; ++j) {
      const float score =
          advantage[pixel] * kernels::logit_score(role, a, at.weights[j], alpha[at.texels[j]]);
      if (can_be_added(score))
        Atomics::add(out[std::size_t(at.texels[j]) * channels + alpha_channel],
                     to_fixed(score, texture_scale));
      else
        good = false;
    }
    return good;
  }

  template <class Atomics>
  TUREEN_HOST_DEVICE bool add_features(std::uint32_t face, std::size_t pixel,
                                       const lattice::Footprint<float>& at) const {
    Fixed* out = sums.texture + face * model.fine_texels() * channels;
    bool good = true;
    for (std::size_t f = 0; f + 1 < channels; ++f) {
      const float gradient = by_features[pixel * channels + f];
      good = good && can_be_added(gradient);
      if (!can_be_added(gradient)) continue;
      for (int j = 0; j < 3; ++j)
        Atomics::add(out[std::size_t(at.texels[j]) * channels + f],
                     to_fixed(at.weights[j] * gradient, texture_scale));
    }
    return good;
  }

  TUREEN_HOST_DEVICE kernels::EdgePixel edge_pixel(const DeviceImage& image,
                                                   std::size_t pixel) const {
    const VisibleKey key = keys[image.first_pixel + pixel];
    kernels::EdgePixel result;
    result.face = key ? face_of(key) : no_face;
    result.inverse_depth = inverse_depth_of(key);
    for (std::size_t c = 0; c < 3; ++c) {
      const std::size_t at = 3 * image.first_pixel + c * image.pixels() + pixel;
      result.color[c] = color[at];
      result.gradient[c] = by_color[at];
    }
    return result;
  }

  /// Adds the gradients from the four edges of a pixel that shows the face.
  TUREEN_HOST_DEVICE void gather_edges(const DeviceImage& image, const Piece& piece,
                                       const kernels::ProjectedFace& face,
                                       const kernels::Fragment& fragment,
                                       float (&corners)[3][3]) const {
    const int width = image.view.width, height = image.view.height;
    const kernels::EdgePixel p =
        edge_pixel(image, std::size_t(fragment.y) * std::size_t(width) + std::size_t(fragment.x));
    for (int side = 0; side < 4; ++side) {
      const int step = side % 2 ? 1 : -1;
      const int x = fragment.x + (side < 2 ? step : 0), y = fragment.y + (side < 2 ? 0 : step);
      if (x < 0 || y < 0 || x >= width || y >= height) continue;
      const kernels::EdgePixel q =
          edge_pixel(image, std::size_t(y) * std::size_t(width) + std::size_t(x));
      const bool background = q.face == no_face;
      const kernels::ProjectedFace* other =
          background ? nullptr : projections.faces + piece.image * model.faces + q.face;
      const kernels::PointGradient point = kernels::edge_gradient(
          face, other, fragment.x, fragment.y, x, y, p, q, background, slide);
      if (point.kind != kernels::EdgeCase::none)
        kernels::distribute(image.view, face, point, corners);
    }
  }

  template <class Atomics>
  TUREEN_HOST_DEVICE bool add_corners(const kernels::View& view, std::uint32_t face,
                                      const float (&corners)[3][3]) const {
    bool good = true;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        const float gradient = corners[i][0] * float(view.right[j]) +
                               corners[i][1] * float(view.down[j]) +
                               corners[i][2] * float(view.forward[j]);
        if (!can_be_added(gradient))
          good = false;
        else if (gradient != 0)
          Atomics::add(sums.corners[std::size_t(face) * 9 + std::size_t(3 * i + j)],
                       to_fixed(gradient, corner_scale));
      }
    return good;
  }
};

/// The textures of all faces: logits of all levels, and the values for fragments.
struct Textures {
  int min_level, max_level;
  const lattice::Coordinates* coordinates;  // of texels in their order, the same for all levels
  float* logits;                            // [face][texel of all levels][channels]
  float* work;                              // the same size as logits
  float* values;                            // [face][fine texel][channels]
  float* alpha;                             // [face][fine texel]

  TUREEN_HOST_DEVICE unsigned levels() const { return unsigned(max_level - min_level) + 1; }
  TUREEN_HOST_DEVICE std::size_t texels() const {
    return kernels::level_begin(min_level, max_level + 1);
  }
  TUREEN_HOST_DEVICE std::size_t fine_texels() const { return lattice::texel_count(max_level); }

  /// A level's part of `logits` or `work`.
  TUREEN_HOST_DEVICE float* at(float* array, std::size_t face, int level) const {
    return array + (face * texels() + kernels::level_begin(min_level, level)) * channels;
  }

  /// Adds a level of `logits` to the sum of the lower levels, which `work` already holds. The sum
  /// goes to `work`; at the finest level, its sigmoid goes to `values`. One block per face.
  TUREEN_HOST_DEVICE void sum_level(std::size_t face, int level, unsigned thread,
                                    unsigned threads) const {
    const float* own = at(logits, face, level);
    const float* below = level > min_level ? at(work, face, level - 1) : nullptr;
    for (std::size_t i = thread; i < lattice::texel_count(level) * channels; i += threads) {
      const std::size_t texel = i / channels, channel = i % channels;
      float sum = own[i];
      if (below) {
        const kernels::Parents parents =
            kernels::parents(coordinates[texel].x, coordinates[texel].y);
        sum += 0.5f * (below[std::size_t(parents.a) * channels + channel] +
                       below[std::size_t(parents.b) * channels + channel]);
      }
      if (level < max_level) {
        at(work, face, level)[i] = sum;
        continue;
      }
      const float value = kernels::sigmoid(sum);
      values[face * fine_texels() * channels + i] = value;
      if (channel == alpha_channel) alpha[face * fine_texels() + texel] = value;
    }
  }

  /// The transpose of a refinement: the gradient in `work` at level + 1 becomes that at `level`.
  TUREEN_HOST_DEVICE void coarsen_level(std::size_t face, int level, unsigned thread,
                                        unsigned threads) const {
    const float* fine = at(work, face, level + 1);
    float* coarse = at(work, face, level);
    const int resolution = lattice::resolution(level + 1);
    for (std::size_t i = thread; i < lattice::texel_count(level) * channels; i += threads) {
      const std::size_t channel = i % channels;
      const int x = 2 * coordinates[i / channels].x, y = 2 * coordinates[i / channels].y;
      float sum = fine[lattice::texel_index(x, y) * channels + channel];
      // The six fine texels in the middle to a neighbour.
      const int steps[6][2] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, -1}, {-1, 1}};
      for (const auto& step : steps) {
        const int nx = x + step[0], ny = y + step[1];
        if (nx >= 0 && ny >= 0 && nx + ny <= resolution)
          sum += 0.5f * fine[lattice::texel_index(nx, ny) * channels + channel];
      }
      coarse[i] = sum;
    }
  }
};

/// Computes all textures. One block per face.
struct RefreshTextures {
  static constexpr unsigned threads = 128;
  using Shared = Nothing;
  using Local = Nothing;
  Textures textures;

  TUREEN_HOST_DEVICE unsigned phases() const { return textures.levels(); }
  template <class Atomics>
  TUREEN_HOST_DEVICE void run(unsigned phase, const Thread& at, Shared&, Local&) const {
    textures.sum_level(at.block, textures.min_level + int(phase), at.thread, threads);
  }
};

/// Steps the touched faces, or all faces with dense_updates. One block per face.
struct StepFaces {
  static constexpr unsigned threads = 128;
  struct Shared {
    bool active;
    unsigned flags;
    kernels::AdamStep texture, vertex;
  };
  using Local = Nothing;
  Textures textures;
  FaceSums sums;
  float* positions;                     // [face][3][3]
  float *first, *second;                // layout of Textures::logits
  float *vertex_first, *vertex_second;  // [face][3][3], [face][3]
  std::uint32_t* steps;                 // [face]
  float* errors;                        // [face]: TrainingState::errors
  float texture_rate, vertex_rate, beta1, beta2, epsilon;
  std::size_t fixed_faces;  // the corners of the first faces stay
  bool dense_updates;
  unsigned long long* non_finite;

  // Phases: begin, take the sums, coarsen level by level, step, sum level by level, end.
  TUREEN_HOST_DEVICE unsigned phases() const { return 2 + (levels() - 1) + 1 + levels() + 1; }
  TUREEN_HOST_DEVICE unsigned levels() const { return textures.levels(); }

  template <class Atomics>
  TUREEN_HOST_DEVICE void run(unsigned phase, const Thread& at, Shared& shared, Local&) const {
    const std::size_t face = at.block;
    const unsigned step_phase = levels() + 1;
    if (phase == 0) {
      if (at.thread == 0) begin(face, shared);
      return;
    }
    if (!shared.active) return;
    if (phase == 1)
      take_sums<Atomics>(face, at.thread, shared);
    else if (phase < step_phase)
      textures.coarsen_level(face, textures.max_level - int(phase) + 1, at.thread, threads);
    else if (phase == step_phase)
      step(face, at.thread, shared);
    else if (phase <= step_phase + levels())
      textures.sum_level(face, textures.min_level + int(phase - step_phase) - 1, at.thread,
                         threads);
    else if (at.thread == 0)
      end<Atomics>(face, shared);
  }

  TUREEN_HOST_DEVICE void begin(std::size_t face, Shared& shared) const {
    shared.flags = sums.flags[face];
    shared.active = (shared.flags & touched_flag) || dense_updates;
    if (!shared.active) return;
    const double t = double(steps[face]) + 1;
    shared.texture = kernels::adam_step(texture_rate, beta1, beta2, epsilon, t);
    shared.vertex = kernels::adam_step(vertex_rate, beta1, beta2, epsilon, t);
  }

  /// Multiplies the feature gradients by the sigmoid's derivative. The score is already a
  /// derivative by the logit.
  template <class Atomics>
  TUREEN_HOST_DEVICE void take_sums(std::size_t face, unsigned thread, Shared& shared) const {
    const std::size_t count = textures.fine_texels() * channels;
    Fixed* in = sums.texture + face * count;
    const float* values = textures.values + face * count;
    float* out = textures.at(textures.work, face, textures.max_level);
    for (std::size_t i = thread; i < count; i += threads) {
      const float gradient = from_fixed(in[i], texture_scale), v = values[i];
      in[i] = 0;
      out[i] = i % channels == alpha_channel ? gradient : gradient * v * (1.0f - v);
      // Sums are always finite; textures may not be.
      if (!std::isfinite(out[i])) Atomics::set_bits(shared.flags, bad_texture_flag);
    }
  }

  TUREEN_HOST_DEVICE void step(std::size_t face, unsigned thread, const Shared& shared) const {
    const std::size_t count = textures.texels() * channels;
    if (!(shared.flags & bad_texture_flag))
      for (std::size_t i = face * count + thread; i < (face + 1) * count; i += threads)
        kernels::adam(shared.texture, textures.work[i], textures.logits[i], first[i], second[i]);
    if (thread >= 3) return;
    const std::size_t vertex = 3 * face + thread;
    float gradient[3];
    for (std::size_t j = 0; j < 3; ++j) {
      gradient[j] = from_fixed(sums.corners[3 * vertex + j], corner_scale);
      sums.corners[3 * vertex + j] = 0;
    }
    if (face >= fixed_faces && !(shared.flags & bad_corners_flag))
      kernels::vector_adam(shared.vertex, gradient, positions + 3 * vertex,
                           vertex_first + 3 * vertex, vertex_second[vertex]);
  }

  template <class Atomics>
  TUREEN_HOST_DEVICE void end(std::size_t face, const Shared& shared) const {
    ++steps[face];
    sums.flags[face] = 0;
    errors[face] += from_fixed(sums.errors[face], loss_scale);
    sums.errors[face] = 0;
    const unsigned quarantined =
        unsigned((shared.flags & bad_texture_flag) != 0) +
        unsigned((shared.flags & bad_corners_flag) != 0 && face >= fixed_faces);
    if (quarantined) Atomics::add(*non_finite, static_cast<unsigned long long>(quarantined));
  }
};

/// Steps the network with the sum over the blocks of ShadeBackward. One block.
struct StepNetwork {
  static constexpr unsigned threads = 608;  // mlp_parameters (595) rounded up to whole warps
  struct Shared {
    float gradient[mlp_parameters];
    bool good;
    kernels::AdamStep step;
  };
  using Local = Nothing;
  const float* by_mlp;  // [block][mlp_parameters]
  unsigned blocks;
  float *mlp, *first, *second;
  std::uint32_t* steps;
  float rate, beta1, beta2, epsilon;
  unsigned long long* non_finite;

  TUREEN_HOST_DEVICE unsigned phases() const { return 3; }
  template <class Atomics>
  TUREEN_HOST_DEVICE void run(unsigned phase, const Thread& at, Shared& shared, Local&) const {
    static_assert(threads >= mlp_parameters);
    const unsigned i = at.thread;
    if (phase == 0 && i < mlp_parameters) {
      double sum = 0;
      for (unsigned block = 0; block < blocks; ++block)
        sum += double(by_mlp[std::size_t(block) * mlp_parameters + i]);
      shared.gradient[i] = float(sum);
    } else if (phase == 1 && i == 0) {
      shared.good = true;
      for (const float g : shared.gradient) shared.good = shared.good && kernels::can_be_squared(g);
      if (shared.good)
        shared.step = kernels::adam_step(rate, beta1, beta2, epsilon, double(++*steps));
      else
        Atomics::add(*non_finite, 1ull);
    } else if (phase == 2 && i < mlp_parameters && shared.good) {
      kernels::adam(shared.step, shared.gradient[i], mlp[i], first[i], second[i]);
    }
  }
};

}  // namespace tureen::trainer::cuda
