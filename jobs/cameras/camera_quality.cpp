#include "jobs/cameras/camera_quality.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/matrix.hpp>
#include <map>
#include <set>
#include <utility>

#include "base/decimal_text.hpp"
#include "formats/dataset/colmap.hpp"
#include "jobs/cameras/camera_remarks.hpp"

namespace tureen {

namespace {

namespace fs = std::filesystem;

template <class T>
T median(std::vector<T> values) {
  if (values.empty()) return T(0);
  const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

double norm(const glm::dmat3& m) {
  return std::sqrt(glm::dot(m[0], m[0]) + glm::dot(m[1], m[1]) + glm::dot(m[2], m[2]));
}

/// How far the homography moves a point of the photograph's border, in pixels.
double moved(const glm::dmat3& homography, double side) {
  double most = 0;
  for (const glm::dvec3 corner : {glm::dvec3(0, 0, 1), glm::dvec3(side, 0, 1),
                                  glm::dvec3(0, side, 1), glm::dvec3(side, side, 1)}) {
    const glm::dvec3 other = homography * corner;
    const glm::dvec2 offset = glm::dvec2(other) / other.z - glm::dvec2(corner);
    most = std::max(most, std::isfinite(offset.x + offset.y) ? glm::length(offset) : side);
  }
  return most;
}

/// Of a camera that turns, the homography is K R K^-1 with a rotation R (R. Hartley,
/// "Self-calibration of stationary cameras", IJCV 1997). Returns |M M^T - 1| / |M - 1| of M = K^-1
/// H K for the best focal length: 0 for a rotation, above 1 for a plane that the camera moves
/// along.
double unlike_rotation(const std::vector<glm::dmat3>& homographies, double side) {
  double best = 2;
  // From a fisheye's focal length to that of a long telephoto lens, in steps of a tenth.
  for (double focal = 0.3 * side; focal < 6 * side; focal *= 1.1) {
    std::vector<double> errors;
    for (const glm::dmat3& homography : homographies) {
      // The principal point is near the centre; photographs are at most `side` wide and high, so
      // that the centre of the square is off by less than an eighth of it.
      const glm::dmat3 k(focal, 0, 0, 0, focal, 0, 0.5 * side, 0.5 * side, 1);
      glm::dmat3 m = glm::inverse(k) * homography * k;
      m /= std::cbrt(glm::determinant(m));
      errors.push_back(norm(m * glm::transpose(m) - glm::dmat3(1)) /
                       std::max(norm(m - glm::dmat3(1)), 1e-9));
    }
    best = std::min(best, median(std::move(errors)));
  }
  return best;
}

/// "a, b to f and 12 others": names in their order, neighbours as ranges.
std::vector<std::string> ranges(const std::vector<std::string>& names,
                                const std::set<std::string>& chosen) {
  std::vector<std::string> parts;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (!chosen.count(names[i])) continue;
    std::size_t last = i;
    while (last + 1 < names.size() && chosen.count(names[last + 1])) ++last;
    parts.push_back(last == i ? names[i]
                              : names[i] + (last == i + 1 ? ", " : " to ") + names[last]);
    i = last;
  }
  constexpr std::size_t most = 6;
  if (parts.size() > most) {
    const std::size_t others = parts.size() - (most - 1);
    parts.resize(most - 1);
    parts.push_back(counted(others, "other group"));
  }
  return parts;
}

/// `is_placed`: whether COLMAP has placed half of the photographs, which it also does, with a wrong
/// lens and a wrong depth, with those of a turning camera.
void judge_matches(const MatchFacts& matches, bool is_placed, CameraQuality& quality) {
  // Below these, hardly any pair of photographs has the 15 matches that COLMAP needs.
  constexpr std::size_t few_features = 100;
  // A pair that one homography explains is common, 41 % of the fox's; nearly all pairs of a set are
  // not.
  constexpr double most = 0.8;
  // All pairs of four photographs: fewer are flat by chance.
  constexpr std::size_t evidence = 6;
  const bool is_flat = matches.flat_pairs > most && matches.pairs >= evidence;
  if (!is_placed && matches.features < few_features)
    quality.refusals.push_back({&remarks::few_features, {{"features", matches.features}}});
  else if (!is_placed && matches.pairs == 0)
    quality.refusals.push_back({&remarks::no_overlap});
  else if (matches.unmoved_pairs > most)
    quality.refusals.push_back({&remarks::no_motion});
  else if (is_flat && matches.is_turning)
    quality.refusals.push_back({&remarks::only_turning});
  else if (is_flat && (quality.is_flat || !is_placed))
    quality.refusals.push_back({&remarks::flat_pictures});
}

/// The largest angle between two rays to the point, in degrees. Of long tracks, 16 rays.
double widest_angle(const ColmapTrack& track, const std::map<std::uint32_t, glm::dvec3>& eyes) {
  std::vector<glm::dvec3> rays;
  const std::size_t step = std::max<std::size_t>(1, track.images.size() / 16);
  for (std::size_t i = 0; i < track.images.size(); i += step)
    if (const auto eye = eyes.find(track.images[i]); eye != eyes.end())
      rays.push_back(glm::normalize(track.position - eye->second));
  double least = 1;
  for (std::size_t i = 0; i < rays.size(); ++i)
    for (std::size_t j = i + 1; j < rays.size(); ++j)
      least = std::min(least, glm::dot(rays[i], rays[j]));
  return std::acos(std::clamp(least, -1.0, 1.0)) * 180 / glm::pi<double>();
}

/// Whether points with this covariance, times any factor, lie near a plane: within 5 % of their
/// second largest extent. A wrong lens bends a plane by 1 to 2 %; the fox's points have 50 %. With
/// eigenvalues a >= b >> c, c / b is about det tr / (sum of the principal minors)^2.
bool is_flat(const glm::dmat3& m) {
  const double minors = m[0][0] * m[1][1] - m[0][1] * m[1][0] + m[0][0] * m[2][2] -
                        m[0][2] * m[2][0] + m[1][1] * m[2][2] - m[1][2] * m[2][1];
  const double trace = m[0][0] + m[1][1] + m[2][2];
  return glm::determinant(m) * trace < 0.05 * 0.05 * minors * minors;
}

/// A model of the mapper.
struct Model {
  fs::path folder;
  std::map<std::uint32_t, glm::dvec3> eyes = {};  // by ColmapImage::number
  std::set<std::string> names = {};               // of the photographs with a camera
};

/// The models below `folder`, the largest first.
std::vector<Model> models_in(const fs::path& folder) {
  std::vector<Model> models;
  for (int i = 0; is_colmap_model(folder / std::to_string(i)); ++i) {
    Model& model = models.emplace_back(Model{.folder = folder / std::to_string(i)});
    for (const ColmapImage& image : read_colmap_poses(model.folder).images) {
      model.eyes[image.number] = glm::dvec3(glm::inverse(image.view_from_world)[3]);
      if (image.defect.empty()) model.names.insert(image.name);
    }
  }
  std::stable_sort(models.begin(), models.end(),
                   [](const Model& a, const Model& b) { return a.names.size() > b.names.size(); });
  return models;
}

void measure(const Model& model, CameraQuality& quality) {
  const std::vector<ColmapTrack> tracks = read_colmap_tracks(model.folder);
  quality.points = tracks.size();
  if (tracks.empty()) return;
  std::vector<double> angles;
  double sightings = 0;
  glm::dvec3 mean(0);
  glm::dmat3 spread(0);
  for (const ColmapTrack& track : tracks) mean += track.position / double(tracks.size());
  for (const ColmapTrack& track : tracks) {
    const glm::dvec3 offset = track.position - mean;
    spread += glm::outerProduct(offset, offset);
    quality.error_px += track.error / double(tracks.size());
    sightings += double(track.images.size());
    angles.push_back(widest_angle(track, model.eyes));
  }
  quality.photographs_per_point = sightings / double(tracks.size());
  quality.points_per_photograph =
      double(tracks.size()) / double(std::max<std::size_t>(1, quality.registered));
  quality.parallax_degrees = median(std::move(angles));
  quality.is_flat = is_flat(spread);
}

}  // namespace

MatchFacts match_facts(const FeatureDatabase& database, double longer_side) {
  MatchFacts facts;
  std::vector<std::size_t> features;
  for (const FeatureDatabase::Photo& photo : database.photos())
    features.push_back(std::size_t(photo.features));
  facts.features = median(std::move(features));
  std::vector<glm::dmat3> homographies;
  for (const FeatureDatabase::Pair& pair : database.pairs()) {
    // COLMAP's mapper uses pairs with this many matches.
    if (pair.matches < 15) continue;
    ++facts.pairs;
    if (!pair.is_flat || pair.second_from_first == glm::dmat3(0)) continue;
    ++facts.flat_pairs;
    homographies.push_back(pair.second_from_first);
    // 1 %: a camera on a tripod shakes less, and no scene can be measured from so small a step.
    facts.unmoved_pairs += moved(pair.second_from_first, longer_side) < 0.01 * longer_side;
  }
  if (facts.pairs == 0) return facts;
  facts.flat_pairs /= double(facts.pairs);
  facts.unmoved_pairs /= double(facts.pairs);
  facts.is_turning = !homographies.empty() && unlike_rotation(homographies, longer_side) < 0.5;
  return facts;
}

CameraQuality judge(const fs::path& folder, const std::vector<std::string>& names,
                    const MatchFacts& matches) {
  CameraQuality quality{.photographs = names.size()};
  const std::vector<Model> models = models_in(folder);
  for (const Model& model : models) quality.models.push_back(model.names.size());
  std::set<std::string> missing(names.begin(), names.end());
  if (!models.empty()) {
    quality.best = models[0].folder;
    quality.registered = quality.models[0];
    for (const std::string& name : models[0].names) missing.erase(name);
    measure(models[0], quality);
  }
  quality.unregistered.assign(missing.begin(), missing.end());

  const std::size_t all = quality.photographs, registered = quality.registered;
  judge_matches(matches, 2 * registered >= all, quality);
  const std::vector<std::string> without = ranges(names, missing);
  // Photographs that only some model has. COLMAP repeats a few of another model.
  std::size_t others = 0;
  for (std::size_t i = 1; i < models.size(); ++i)
    for (const std::string& name : models[i].names) others += missing.count(name);
  if (quality.refusals.empty()) {
    // A tenth: fewer are strays, such as some photographs of the ceiling.
    if (others >= least_photographs && 10 * others >= all) {
      std::vector<std::string> parts;
      for (std::size_t i = 0; i < std::min<std::size_t>(models.size(), 4); ++i) {
        const std::vector<std::string> part = ranges(names, models[i].names);
        if (part.empty()) continue;
        parts.push_back(part.front() + (part.size() > 1 ? " and others: " : ": ") +
                        std::to_string(models[i].names.size()));
      }
      quality.refusals.push_back(
          {&remarks::several_models, {{"count", models.size()}, {"parts", parts}}});
    } else if (2 * registered < all || registered < least_photographs) {
      quality.refusals.push_back({&remarks::few_registered,
                                  {{"registered", registered}, {"all", all}, {"names", without}}});
    }
    // Good sets have a median of 5 to 40 degrees; COLMAP drops points below 1.5.
    if (registered > 0 && quality.parallax_degrees < 2)
      quality.refusals.push_back(
          {&remarks::little_parallax, {{"degrees", quality.parallax_degrees}}});
    if (registered > 0 && quality.points_per_photograph < 10)
      quality.refusals.push_back(
          {&remarks::few_points, {{"points", std::uint64_t(quality.points_per_photograph)}}});
  }
  if (!missing.empty() && quality.refusals.empty())
    quality.notes.push_back({&remarks::photographs_unregistered,
                             {{"count", missing.size()}, {"all", all}, {"names", without}}});
  if (others > 0 && quality.refusals.empty())
    quality.notes.push_back({&remarks::smaller_models, {{"count", others}}});
  return quality;
}

std::vector<std::string> describe(const CameraQuality& quality) {
  std::vector<std::string> lines{fmt::format("{} of {} registered", quality.registered,
                                             counted(quality.photographs, "photograph"))};
  if (quality.models.size() > 1)
    lines[0] += fmt::format(", in the largest of {} models", quality.models.size());
  if (quality.points > 0) {
    lines.push_back(fmt::format("{}, {:.0f} for each photograph, each in {:.1f} photographs",
                                counted(quality.points, "point"), quality.points_per_photograph,
                                quality.photographs_per_point));
    lines.push_back(fmt::format(
        "reprojection error {:.2f} px; parallax {:.1f} degrees, the median of the points",
        quality.error_px, quality.parallax_degrees));
  }
  return lines;
}

Json to_json(const CameraQuality& quality) {
  return {{"photographs", quality.photographs},
          {"registered", quality.registered},
          {"models", quality.models},
          {"points", quality.points},
          {"reprojection_error_px", quality.error_px},
          {"photographs_per_point", quality.photographs_per_point},
          {"points_per_photograph", quality.points_per_photograph},
          {"parallax_degrees", quality.parallax_degrees},
          {"unregistered", quality.unregistered}};
}

}  // namespace tureen
