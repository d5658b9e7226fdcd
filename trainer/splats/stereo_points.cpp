#include "trainer/splats/stereo_points.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <optional>
#include <set>
#include <utility>

#include "base/threads/thread_pool.hpp"
#include "trainer/common/random.hpp"
#include "trainer/common/training_views.hpp"

namespace tureen::trainer {

namespace {

/// Photographs are halved until they have at most this many pixels: noise and small errors of the
/// cameras vanish, and neighbouring depths of the sweep are about a pixel apart.
constexpr std::int64_t max_pixels = 1 << 16;
constexpr int depths = 192;
constexpr int radius = 2;  // of a patch, in pixels
constexpr int patch_pixels = (2 * radius + 1) * (2 * radius + 1);
constexpr std::size_t most_neighbours = 4;
/// Between two cameras, as a fraction of the distance to the region: near enough that patches look
/// alike, and far enough that depths differ.
constexpr double best_baseline = 0.15;
/// The nearest depth, as a fraction of the distance to the region, and the farthest, in half sides
/// behind it.
constexpr double nearest = 0.25, farthest = 8;
/// Standard deviation of a patch with texture: four times the rounding to bytes, and noise.
constexpr float least_texture = 4.0f / 255;
/// Correlation of a match; and by how much it exceeds that of all other depths. First guesses,
/// not tuned.
constexpr float least_correlation = 0.8f, least_lead = 0.05f;
/// Random pixels for each point.
constexpr std::size_t tries = 8;
/// More would take more than 150 MB, whatever the limit of the memory is.
constexpr std::size_t most_photographs = 300;
/// The first of the streams of random numbers, one per task; other purposes have small numbers.
constexpr std::uint64_t first_stream = 1 << 20;

struct Image {
  Camera camera;
  std::vector<float> luma;
  std::vector<glm::u8vec3> colors;
  std::vector<std::uint8_t> ignored;  // as of TrainingView

  std::size_t place(int x, int y) const {
    return std::size_t(y) * std::size_t(camera.width) + std::size_t(x);
  }
};

/// A neighbour of a camera: a pixel p of the camera at the inverse depth w is at the homogeneous
/// pixel turn * p + w * shift of the neighbour.
struct Neighbour {
  const Image* image;
  glm::dmat3 turn;
  glm::dvec3 shift;
};

using Pixel = std::pair<std::size_t, std::size_t>;  // image, place

struct Sweep {
  const Image* image;
  std::vector<Neighbour> neighbours;
  double first = 0, step = 0;  // inverse depths
};

using Patch = std::array<float, patch_pixels>;

Image image_of(const Photograph& photograph, std::span<const float, 3> background) {
  TrainingView view = halved_to(training_view(photograph, background), max_pixels, 1);
  const std::size_t count = view.target.size() / 3;
  Image image{.camera = view.camera,
              .luma = std::vector<float>(count),
              .colors = std::vector<glm::u8vec3>(count),
              .ignored = std::move(view.ignored)};
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t c = 0; c < 3; ++c) image.colors[i][int(c)] = view.target[c * count + i];
    const glm::vec3 color = glm::vec3(image.colors[i]) / 255.0f;
    image.luma[i] = glm::dot(color, {0.299f, 0.587f, 0.114f});  // ITU-R BT.601
  }
  return image;
}

/// Homogeneous pixels of points in view space.
glm::dmat3 pixels_from_view(const Camera& camera) {
  return {{camera.fx, 0, 0}, {0, -camera.fy, 0}, {-camera.cx, -camera.cy, -1}};
}

/// Subtracts the mean and divides by the length. Returns whether the patch has texture.
bool normalise(Patch& patch) {
  float sum = 0, square = 0;
  for (const float value : patch) sum += value;
  for (float& value : patch) {
    value -= sum / patch_pixels;
    square += value * value;
  }
  if (square < least_texture * least_texture * patch_pixels) return false;
  const float factor = 1 / std::sqrt(square);
  for (float& value : patch) value *= factor;
  return true;
}

/// The correlation of `patch` around the pixel (x, y) with the neighbour at an inverse depth;
/// nullopt if it is outside of its image.
std::optional<float> correlation(const Patch& patch, int x, int y, const Neighbour& neighbour,
                                 double inverse_depth) {
  const Image& image = *neighbour.image;
  Patch other;
  float* out = other.data();
  const glm::dvec3 origin =
      neighbour.turn * glm::dvec3(x + 0.5, y + 0.5, 1.0) + inverse_depth * neighbour.shift;
  for (int dy = -radius; dy <= radius; ++dy)
    for (int dx = -radius; dx <= radius; ++dx) {
      const glm::dvec3 h = origin + double(dx) * neighbour.turn[0] + double(dy) * neighbour.turn[1];
      if (!(h.z > 0)) return std::nullopt;
      const float u = float(h.x / h.z - 0.5), v = float(h.y / h.z - 0.5);
      if (!(u >= 0 && v >= 0 && u < float(image.camera.width - 1) &&
            v < float(image.camera.height - 1)))
        return std::nullopt;
      const int column = int(u), row = int(v);
      const float a = u - float(column), b = v - float(row);
      const float* top = &image.luma[image.place(column, row)];
      const float* bottom = top + image.camera.width;
      *out++ =
          (1 - b) * ((1 - a) * top[0] + a * top[1]) + b * ((1 - a) * bottom[0] + a * bottom[1]);
    }
  if (!normalise(other)) return 0.0f;
  float sum = 0;
  for (std::size_t i = 0; i < patch.size(); ++i) sum += patch[i] * other[i];
  return sum;
}

/// The mean correlation with the better half of the neighbours: the others may not see the surface.
/// At least two must show the place.
float agreement(const Patch& patch, int x, int y, const Sweep& sweep, double inverse_depth) {
  std::array<float, most_neighbours> found;
  std::size_t count = 0;
  for (const Neighbour& neighbour : sweep.neighbours)
    if (const auto value = correlation(patch, x, y, neighbour, inverse_depth))
      found[count++] = *value;
  if (count < 2) return -1;
  std::sort(found.begin(), found.begin() + std::ptrdiff_t(count), std::greater<>());
  const std::size_t half = std::max<std::size_t>(2, (count + 1) / 2);
  float sum = 0;
  for (std::size_t i = 0; i < half; ++i) sum += found[i];
  return sum / float(half);
}

/// The inverse depth of a pixel; nullopt if the photographs do not agree on one.
std::optional<double> inverse_depth_of(const Sweep& sweep, int x, int y) {
  Patch patch;
  for (int dy = -radius; dy <= radius; ++dy)
    std::copy_n(&sweep.image->luma[sweep.image->place(x - radius, y + dy)], 2 * radius + 1,
                &patch[std::size_t((dy + radius) * (2 * radius + 1))]);
  if (!normalise(patch)) return std::nullopt;
  // First every second depth, between which the score hardly changes, then those beside the best.
  std::array<float, depths> scores;
  scores.fill(-1);
  const auto score_at = [&](int k) {
    scores[std::size_t(k)] = agreement(patch, x, y, sweep, sweep.first + k * sweep.step);
  };
  const auto best_depth = [&] {
    return int(std::max_element(scores.begin(), scores.end()) - scores.begin());
  };
  for (int k = 1; k < depths; k += 2) score_at(k);
  const int coarse = best_depth();
  if (scores[std::size_t(coarse)] < least_correlation - least_lead) return std::nullopt;
  // Neighbouring depths show nearly the same pixels.
  for (int k = 0; k < depths; ++k)
    if (std::abs(k - coarse) > 3 &&
        scores[std::size_t(k)] > scores[std::size_t(coarse)] - least_lead)
      return std::nullopt;
  for (const int k : {coarse - 1, coarse + 1})
    if (k >= 0 && k < depths) score_at(k);
  const int best = best_depth();
  const float score = scores[std::size_t(best)];
  if (score < least_correlation || best == 0 || best == depths - 1) return std::nullopt;
  if (best != coarse) score_at(2 * best - coarse);
  // The vertex of the parabola through three scores.
  const float before = scores[std::size_t(best - 1)], after = scores[std::size_t(best + 1)];
  const float curvature = before - 2 * score + after;
  const double offset = curvature < 0 ? 0.5 * double(before - after) / double(curvature) : 0;
  return sweep.first + (best + std::clamp(offset, -0.5, 0.5)) * sweep.step;
}

Sweep sweep_of(std::span<const Image> images, std::size_t index, const Region& region) {
  Sweep sweep{.image = &images[index], .neighbours = {}};
  const Camera& camera = sweep.image->camera;
  const glm::dvec3 eye = camera.eye();
  const double distance = std::max(glm::distance(eye, region.center), region.half_side);
  sweep.first = 1 / (distance + farthest * region.half_side);
  sweep.step = (1 / (nearest * distance) - sweep.first) / (depths - 1);

  std::vector<std::pair<double, std::size_t>> others;
  const glm::dmat3 turn = camera.world_from_view_rotation();
  for (std::size_t i = 0; i < images.size(); ++i) {
    const double baseline = glm::distance(images[i].camera.eye(), eye) / distance;
    const double cosine = glm::dot(images[i].camera.world_from_view_rotation()[2], turn[2]);
    // Beyond 60 degrees, the same surface is hardly seen.
    if (i != index && baseline > 0 && cosine > 0.5)
      others.emplace_back(std::abs(std::log(baseline / best_baseline)), i);
  }
  std::sort(others.begin(), others.end());
  if (others.size() > most_neighbours) others.resize(most_neighbours);
  const glm::dmat3 view_from_pixels = glm::inverse(pixels_from_view(camera));
  for (const auto& [cost, i] : others) {
    const Camera& other = images[i].camera;
    const glm::dmat3 pixels = pixels_from_view(other);
    sweep.neighbours.push_back(
        {.image = &images[i],
         .turn = pixels * glm::dmat3(other.view_from_world) * turn * view_from_pixels,
         .shift = pixels * (glm::dmat3(other.view_from_world) * eye +
                            glm::dvec3(other.view_from_world[3]))});
  }
  return sweep;
}

}  // namespace

std::vector<DatasetPoint> stereo_points(std::span<const Photograph> photographs,
                                        const Region& region, std::span<const float, 3> background,
                                        std::size_t count, std::uint64_t seed, int threads,
                                        const std::function<void(double fraction)>& progress) {
  if (photographs.size() < 3) return {};
  ThreadPool pool(threads);
  const std::size_t every = (photographs.size() + most_photographs - 1) / most_photographs;
  std::vector<Image> images;
  // One after the other: each takes the memory of a whole photograph.
  for (std::size_t i = 0; i < photographs.size(); i += every)
    images.push_back(image_of(photographs[i], background));
  std::vector<Sweep> sweeps(images.size());
  for (std::size_t i = 0; i < images.size(); ++i) sweeps[i] = sweep_of(images, i, region);

  constexpr std::size_t pixels_a_task = 256;
  const std::size_t batch = 1 + count / pixels_a_task;  // tasks between two reports of progress
  std::vector<DatasetPoint> points;
  std::set<Pixel> taken;  // a pixel drawn again gives the same point
  for (std::size_t first = 0; first < tries * batch && points.size() < count; first += batch) {
    if (progress) progress(double(points.size()) / double(count));
    std::vector<std::vector<std::pair<Pixel, DatasetPoint>>> found(batch);
    pool.run(batch, [&](std::size_t task) {
      Random random(seed, first_stream + first + task);
      for (std::size_t i = 0; i < pixels_a_task; ++i) {
        const std::size_t index = random.below(sweeps.size());
        const Sweep& sweep = sweeps[index];
        const Camera& camera = sweep.image->camera;
        if (camera.width <= 2 * radius || camera.height <= 2 * radius) continue;
        const int x = radius + int(random.below(std::uint64_t(camera.width - 2 * radius)));
        const int y = radius + int(random.below(std::uint64_t(camera.height - 2 * radius)));
        const std::size_t place = sweep.image->place(x, y);
        if (!sweep.image->ignored.empty() && sweep.image->ignored[place]) continue;
        const auto inverse_depth = inverse_depth_of(sweep, x, y);
        if (!inverse_depth) continue;
        const glm::dvec3 ray((x + 0.5 - camera.cx) / camera.fx, (camera.cy - y - 0.5) / camera.fy,
                             -1.0);
        found[task].push_back(
            {{index, place},
             {.position = camera.eye() + camera.world_from_view_rotation() * (ray / *inverse_depth),
              .color = sweep.image->colors[place]}});
      }
    });
    for (const auto& some : found)
      for (const auto& [pixel, point] : some)
        if (taken.insert(pixel).second) points.push_back(point);
  }
  if (points.size() > count) points.resize(count);
  return points;
}

}  // namespace tureen::trainer
