#include "trainer/diffsoup/topology.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <glm/common.hpp>
#include <limits>
#include <numeric>

#include "scene/morton.hpp"
#include "trainer/diffsoup/levels.hpp"

namespace tureen::trainer {

namespace {

/// A model with the same levels, MLP and origin, but without faces.
Model without_faces(const Model& model) {
  return {.min_level = model.min_level,
          .max_level = model.max_level,
          .positions = {},
          .logits = {},
          .mlp = model.mlp,
          .origin = model.origin};
}

/// These faces of the model, in this order.
Resampled gathered(const Model& model, std::vector<std::uint32_t> kept) {
  Resampled result{without_faces(model), {}, std::vector<std::uint8_t>(kept.size(), 0)};
  result.model.positions.reserve(3 * kept.size());
  result.model.logits.reserve(kept.size() * model.texels() * channels);
  for (const std::uint32_t face : kept) {
    for (int corner = 0; corner < 3; ++corner)
      result.model.positions.push_back(model.positions[3 * std::size_t(face) + corner]);
    const auto logits = model.face_logits(face);
    result.model.logits.insert(result.model.logits.end(), logits.begin(), logits.end());
  }
  result.origin = std::move(kept);
  return result;
}

/// A face of the new model: the positions of its corners on the old face, in barycentrics.
struct Piece {
  std::uint32_t origin;
  bool is_new = false;
  std::array<glm::dvec3, 3> corners{
      {glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0), glm::dvec3(0, 0, 1)}};
};

/// Cuts positions and pieces alike.
void cut(const Split& split, std::vector<Piece>& pieces, std::vector<glm::vec3>& positions) {
  assert(split.face < pieces.size() && split.edge >= 0 && split.edge < 3);
  assert(split.t >= 0 && split.t <= 1);
  const int from = split.edge, to = (split.edge + 1) % 3;
  Piece& first = pieces[split.face];
  first.is_new = true;
  Piece second = first;
  const double t = split.t;
  first.corners[to] = second.corners[from] =
      (1 - t) * second.corners[from] + t * second.corners[to];
  pieces.push_back(second);
  cut_face(positions, split);
}

/// Samples the texture of a face at any point: interpolated sigmoids of its fine texels. It stores
/// both the value and 1 - value, so large logits are recovered without cancellation.
class ShownTexture {
 public:
  explicit ShownTexture(const Model& model) : model_(model) {
    logits_.resize(std::size_t(lattice::texel_count(model.max_level)) * channels);
    values_.resize(logits_.size());
  }

  void set_face(std::size_t face) {
    fine_logits(model_, face, logits_);
    for (std::size_t i = 0; i < logits_.size(); ++i) {
      // e^710 would overflow. Beyond +-500 the sigmoids are 0 or 1 in any case.
      const double e = std::exp(std::clamp(double(logits_[i]), -500.0, 500.0));
      values_[i] = {e / (1 + e), 1 / (1 + e)};
    }
  }

  /// The logits of one texel of a piece, for the same value as the parent at that point.
  void sample(glm::dvec3 barycentrics, std::span<float> out) const {
    const auto at = lattice::footprint(model_.max_level, barycentrics[0], barycentrics[1]);
    for (int c = 0; c < channels; ++c) {
      double one = 0, zero = 0;
      for (int k = 0; k < 3; ++k) {
        // A border texel may have a weight of -1e-17, which would change logits of 40.
        const double weight = std::max(at.weights[k], 0.0);
        const Value& value = values_[std::size_t(at.texels[k]) * channels + c];
        one += weight * value.one;
        zero += weight * value.zero;
      }
      out[c] = static_cast<float>(std::log(one / zero));
    }
  }

 private:
  struct Value {
    double one, zero;  // sigmoid(logit), sigmoid(-logit)
  };
  const Model& model_;
  std::vector<float> logits_;
  std::vector<Value> values_;
};

/// Writes the texels of one piece, level by level.
void resample(const Model& model, const ShownTexture& parent, const Piece& piece,
              std::span<float> out) {
  std::vector<float> fine(std::size_t(lattice::texel_count(model.max_level)) * channels);
  const double step = 1.0 / lattice::resolution(model.max_level);
  for (std::uint32_t texel = 0; texel < lattice::texel_count(model.max_level); ++texel) {
    const auto [x, y] = lattice::texel_coordinates(texel);
    const double b0 = x * step, b1 = y * step;
    parent.sample(b0 * piece.corners[0] + b1 * piece.corners[1] + (1 - b0 - b1) * piece.corners[2],
                  std::span(fine).subspan(std::size_t(texel) * channels, channels));
  }
  levels::decompose(model.min_level, model.max_level, channels, fine, out);
}

}  // namespace

Resampled prune(const Model& model, std::span<const std::uint64_t> pixels, std::size_t count) {
  assert(pixels.size() == model.faces());
  std::vector<std::uint32_t> faces(model.faces());
  std::iota(faces.begin(), faces.end(), 0u);
  if (count < faces.size()) {
    std::nth_element(faces.begin(), faces.begin() + std::ptrdiff_t(count), faces.end(),
                     [&](std::uint32_t a, std::uint32_t b) {
                       return pixels[a] != pixels[b] ? pixels[a] > pixels[b] : a < b;
                     });
    faces.resize(count);
    std::ranges::sort(faces);
  }
  return gathered(model, std::move(faces));
}

Resampled prune_unseen(const Model& model, std::span<const std::uint64_t> pixels) {
  assert(pixels.size() == model.faces());
  std::vector<std::uint32_t> faces;
  for (std::uint32_t face = 0; face < pixels.size(); ++face)
    if (pixels[face] > 0) faces.push_back(face);
  return gathered(model, std::move(faces));
}

void cut_face(std::vector<glm::vec3>& positions, const Split& split) {
  const std::size_t at = 3 * std::size_t(split.face);
  const int from = split.edge, to = (split.edge + 1) % 3;
  const double t = split.t;
  const glm::vec3 point((1 - t) * glm::dvec3(positions[at + from]) +
                        t * glm::dvec3(positions[at + to]));
  for (int corner = 0; corner < 3; ++corner)
    positions.push_back(corner == from ? point : glm::vec3(positions[at + corner]));
  positions[at + to] = point;
}

Resampled in_space_order(const Model& model, std::size_t first) {
  assert(first <= model.faces());
  glm::dvec3 low(std::numeric_limits<double>::infinity()), high(-low);
  for (const glm::vec3& p : model.positions) {
    low = glm::min(low, glm::dvec3(p));
    high = glm::max(high, glm::dvec3(p));
  }
  // 2^21 steps along the longest side. The order of positions that are not finite is arbitrary.
  const glm::dvec3 size = high - low;
  const double steps = 2097151 / std::max({size.x, size.y, size.z, 1e-30});
  std::vector<std::uint64_t> places;
  for (std::size_t face = 0; face < model.faces(); ++face) {
    const glm::vec3* p = &model.positions[3 * face];
    const glm::dvec3 at =
        ((glm::dvec3(p[0]) + glm::dvec3(p[1]) + glm::dvec3(p[2])) / 3.0 - low) * steps;
    std::uint64_t place = 0;
    for (int axis = 0; axis < 3; ++axis)
      place |= spread_bits(at[axis] >= 0 && at[axis] <= 2097151 ? std::uint64_t(at[axis]) : 0)
               << axis;
    places.push_back(place);
  }
  std::vector<std::uint32_t> order(model.faces());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin() + std::ptrdiff_t(first), order.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return places[a] < places[b]; });
  return gathered(model, std::move(order));
}

Resampled split(const Model& model, std::span<const Split> splits, ChildTexture texture) {
  std::vector<Piece> pieces;
  pieces.reserve(model.faces() + splits.size());
  for (std::size_t face = 0; face < model.faces(); ++face)
    pieces.push_back({.origin = std::uint32_t(face)});
  Resampled result{without_faces(model), {}, {}};
  result.model.positions.reserve(3 * (model.faces() + splits.size()));
  result.model.positions = model.positions;
  for (const Split& one : splits) cut(one, pieces, result.model.positions);

  const std::size_t stride = model.texels() * channels;
  result.model.logits.resize(pieces.size() * stride);
  std::vector<std::uint32_t> by_origin(pieces.size());  // a parent's sigmoids are computed once
  std::iota(by_origin.begin(), by_origin.end(), 0u);
  std::ranges::stable_sort(by_origin, {}, [&](std::uint32_t i) { return pieces[i].origin; });
  ShownTexture parent(model);
  std::size_t parent_face = model.faces();
  for (const std::uint32_t i : by_origin) {
    const Piece& piece = pieces[i];
    if (!piece.is_new || texture == ChildTexture::copied) {
      std::ranges::copy(model.face_logits(piece.origin), result.model.face_logits(i).begin());
      continue;
    }
    if (piece.origin != parent_face) parent.set_face(parent_face = piece.origin);
    resample(model, parent, piece, result.model.face_logits(i));
  }
  for (const Piece& piece : pieces) {
    result.origin.push_back(piece.origin);
    result.is_new.push_back(piece.is_new);
  }
  return result;
}

}  // namespace tureen::trainer
