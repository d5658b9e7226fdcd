// How good the cameras are that COLMAP found. Its exit code does not say: a flat picture passes,
// with a wrong lens.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "base/json/json_text.hpp"
#include "jobs/cameras/feature_database.hpp"
#include "scene/remark.hpp"

namespace tureen {

/// The least number of photographs with cameras.
inline constexpr std::size_t least_photographs = 8;

/// What the features and their matches show, before any camera is placed.
struct MatchFacts {
  std::size_t features = 0;  // of a photograph, the median
  std::size_t pairs = 0;     // with verified matches
  double flat_pairs = 0;     // share of these pairs that one homography explains
  double unmoved_pairs = 0;  // share of these pairs that show the same image
  bool is_turning = false;   // whether the homographies are those of one turning camera
};
/// `longer_side`: of the photographs, in pixels.
MatchFacts match_facts(const FeatureDatabase& database, double longer_side);

struct CameraQuality {
  std::size_t photographs = 0, registered = 0;
  std::vector<std::size_t> models = {};  // photographs of each, the largest first
  std::filesystem::path best = {};       // the folder of the largest; empty without models
  std::size_t points = 0;
  double error_px = 0;  // mean reprojection error of the points
  double photographs_per_point = 0;
  double points_per_photograph = 0;  // points / registered
  /// The largest angle between the rays of two cameras to a point, the median of the points.
  double parallax_degrees = 0;
  bool is_flat = false;                        // whether the points lie in a plane
  std::vector<std::string> unregistered = {};  // names
  std::vector<Remark> refusals = {};           // why the cameras should not be used
  std::vector<Remark> notes = {};
};

/// Judges the largest of the mapper's models below `folder`, which may have none. `names`: of all
/// photographs, in order. Throws InputError for models that cannot be read.
CameraQuality judge(const std::filesystem::path& folder, const std::vector<std::string>& names,
                    const MatchFacts& matches);

/// Sentences and numbers, for people: "67 of 67 photographs registered".
std::vector<std::string> describe(const CameraQuality& quality);

/// `photographs`, `registered`, `models[]` (photographs of each), `points`,
/// `reprojection_error_px`, `photographs_per_point`, `points_per_photograph`, `parallax_degrees`,
/// `unregistered[]` (names).
Json to_json(const CameraQuality& quality);

}  // namespace tureen
