// The stages of COLMAP 3.8 that find cameras and points, without a GPU. Options as measured on sets
// of 5 to 101 photographs.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "jobs/cameras/camera_work.hpp"
#include "jobs/cameras/photo_neighbors.hpp"

namespace tureen {

struct ColmapSetup {
  std::filesystem::path database, images;  // a file, a folder
  int threads = 1;
};

struct FeatureRequest {
  std::filesystem::path list = {};  // one name of a photograph in each line
  std::size_t photographs = 0;      // in the list
  int longer_side = 0;              // pixels, of the photographs
  bool is_dense = false;            // also features half as large, in three times the time
  std::size_t most_features = 2048;
  const char* camera_model = "OPENCV";
  bool one_camera = true;                    // for all listed photographs
  std::optional<std::uint32_t> camera = {};  // one that the database already has
};

// Forecasts in seconds.
double feature_seconds(const FeatureRequest& request, int threads);
double match_seconds(std::size_t pairs, double features, int threads);
double map_seconds(std::size_t photographs);

ColmapStage feature_stage(const ColmapSetup& setup, const std::string& name,
                          const FeatureRequest& request);

/// Matches the pairs in portions, each a stage, so that progress and resuming are fine. `names`: of
/// the photographs that `pairs` counts. `features`: of a photograph, a mean.
void match_pairs(CameraWork& work, const ColmapSetup& setup, const std::string& name,
                 const PhotoPairs& pairs, const std::vector<std::string>& names, double features);

/// Cameras and points. `output`: an empty folder, for models 0, 1 and so on. `first_angle`: the
/// smallest angle in degrees between the first two photographs at their points. Failing is a
/// result: no model.
ColmapStage map_stage(const ColmapSetup& setup, const std::string& name,
                      const std::filesystem::path& output, std::size_t photographs,
                      double first_angle);

/// Points for cameras that stay as they are. `input`: a model without points. `output`: a folder.
ColmapStage point_stage(const ColmapSetup& setup, const std::string& name,
                        const std::filesystem::path& input, const std::filesystem::path& output,
                        std::size_t photographs);

}  // namespace tureen
