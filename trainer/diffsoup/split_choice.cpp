#include "trainer/diffsoup/split_choice.hpp"

#include <algorithm>
#include <cassert>
#include <glm/geometric.hpp>
#include <optional>
#include <queue>
#include <utility>

#include "trainer/common/homogeneous_pixels.hpp"

namespace tureen::trainer {

namespace {

/// Minimum distance from a cut to a corner, as a fraction of the edge. Each cut then shortens the
/// edge, even in floats, and an extreme perspective cannot spend the whole budget on one edge.
constexpr double min_cut = 0x1p-10;

struct Candidate {
  double priority;  // a length, or an error
  Split split;

  bool operator<(const Candidate& other) const {  // the top of a priority_queue is the greatest
    return priority != other.priority ? priority < other.priority : split.face > other.split.face;
  }
};

/// The faces after the splits so far, and those splits.
struct Faces {
  std::vector<glm::vec3> positions;
  std::vector<std::uint32_t> origin;
  std::vector<Split> splits;

  explicit Faces(const Model& model) : positions(model.positions) {
    for (std::size_t face = 0; face < model.faces(); ++face) origin.push_back(std::uint32_t(face));
  }

  std::size_t count() const { return origin.size(); }

  /// The longest edge in world units, cut in its middle.
  Candidate longest_edge(std::uint32_t face) const {
    const glm::vec3* corner = &positions[3 * std::size_t(face)];
    Candidate best{-1, {face, 0, 0.5f}};
    for (int edge = 0; edge < 3; ++edge) {
      const double length =
          glm::distance(glm::dvec3(corner[edge]), glm::dvec3(corner[(edge + 1) % 3]));
      if (length > best.priority) best = {length, {face, edge, 0.5f}};
    }
    return best;
  }

  void cut(const Split& split) {
    cut_face(positions, split);
    origin.push_back(origin[split.face]);
    splits.push_back(split);
  }
};

/// Splits by priority until there are `budget` faces or no candidate is left. `candidate` returns
/// the edge to split of a face, or nothing. It is called for every face that `starts` accepts, and
/// for the children.
template <class Starts, class MakeCandidate>
void split_longest(Faces& faces, std::size_t budget, const Starts& starts,
                   const MakeCandidate& candidate) {
  std::priority_queue<Candidate> queue;
  const auto consider = [&](std::size_t face) {
    if (const std::optional<Candidate> longest = candidate(std::uint32_t(face)))
      queue.push(*longest);
  };
  for (std::size_t face = 0; face < faces.count(); ++face)
    if (starts(face)) consider(face);
  while (faces.count() < budget && !queue.empty()) {
    const Split next = queue.top().split;
    queue.pop();
    faces.cut(next);
    consider(next.face);
    consider(faces.count() - 1);
  }
}

/// The part of an edge in a camera's image and beyond its near plane.
class ViewProjection {
 public:
  ViewProjection(const Camera& camera, glm::dvec3 origin, double near)
      : pixels_(camera, origin), near_(near) {}

  glm::dvec3 operator()(glm::vec3 position) const { return pixels_(position); }

  struct Visible {
    double length;  // in pixels
    double t;       // where the projected part is halved
  };

  /// The part of an edge in the image; nothing if the edge is outside.
  std::optional<Visible> visible(glm::dvec3 a, glm::dvec3 b) const {
    double low = 0, high = 1;
    for (int plane = 0; plane <= HomogeneousPixels::sides; ++plane) {
      const double at_a = distance(plane, a), at_b = distance(plane, b);
      if (!(at_a >= 0 || at_b >= 0)) return std::nullopt;  // NaN too
      if (at_a < 0) low = std::max(low, at_a / (at_a - at_b));
      if (at_b < 0) high = std::min(high, at_a / (at_a - at_b));
    }
    if (low >= high) return std::nullopt;
    const glm::dvec3 from = a + low * (b - a), to = a + high * (b - a);
    // Halved in the image: (1 - s) W_from = s W_to.
    const double s = from.z / (from.z + to.z);
    return Visible{glm::length(glm::dvec2(to) / to.z - glm::dvec2(from) / from.z),
                   std::clamp(low + s * (high - low), min_cut, 1 - min_cut)};
  }

 private:
  /// At least 0 on the inner side.
  double distance(int plane, glm::dvec3 point) const {
    return plane == 0 ? point.z - near_ : pixels_.from_side(plane - 1, point);
  }

  HomogeneousPixels pixels_;
  double near_;
};

}  // namespace

std::vector<Split> longest_edges(const Model& model, std::size_t budget, std::size_t first) {
  Faces faces(model);
  split_longest(
      faces, budget, [first](std::size_t face) { return face >= first; },
      [&](std::uint32_t face) { return faces.longest_edge(face); });
  return std::move(faces.splits);
}

std::vector<Split> greatest_errors(const Model& model, std::span<const float> errors,
                                   std::size_t budget, std::size_t first) {
  assert(errors.size() == model.faces());
  Faces faces(model);
  std::vector<double> error(errors.begin(), errors.end());
  split_longest(
      faces, budget, [first](std::size_t face) { return face >= first; },
      [&](std::uint32_t face) {
        // Called again after a cut, first for the half in its place, then for the half at the end.
        if (face == error.size())
          error.push_back(error[faces.splits.back().face]);
        else if (!faces.splits.empty() && faces.splits.back().face == face)
          error[face] *= 0.5;
        Candidate candidate = faces.longest_edge(face);
        // Among faces without error the longest edge comes first; otherwise one face and its halves
        // would take the rest of the budget. Edges of length 0 come last.
        const double length = std::max(candidate.priority, 1e-30);
        candidate.priority = error[face] > 0 ? error[face] : -1 / length;
        return std::optional(candidate);
      });
  return std::move(faces.splits);
}

std::vector<Split> longest_projected_edges(const Model& model, std::span<const SplitView> views,
                                           const ProjectedSplits& rule) {
  assert(rule.near > 0 && rule.fraction > 0);
  Faces faces(model);
  for (const SplitView& view : views) {
    assert(view.visible.size() == model.faces());
    const ViewProjection project(view.camera, model.origin, rule.near);
    const auto longest = [&](std::uint32_t face) -> std::optional<Candidate> {
      const glm::vec3* corner = &faces.positions[3 * std::size_t(face)];
      const glm::dvec3 p[3] = {project(corner[0]), project(corner[1]), project(corner[2])};
      std::optional<Candidate> best;
      for (int edge = 0; edge < 3; ++edge) {
        const auto part = project.visible(p[edge], p[(edge + 1) % 3]);
        if (part && part->length > rule.fraction * view.camera.height &&
            (!best || part->length > best->priority))
          best = Candidate{part->length, {face, edge, float(part->t)}};
      }
      return best;
    };
    split_longest(
        faces, rule.budget,
        [&](std::size_t face) {
          return face >= rule.first && view.visible[faces.origin[face]] != 0;
        },
        longest);
  }
  return std::move(faces.splits);
}

}  // namespace tureen::trainer
