#include "jobs/cameras/colmap_stages.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <sstream>

#include "base/output.hpp"

namespace tureen {

namespace {

/// The words of a command line; each % is the next value.
std::vector<std::string> words(const char* line, const std::vector<std::string>& values) {
  std::vector<std::string> result;
  std::istringstream text(line);
  auto value = values.begin();
  for (std::string word; text >> word;) result.push_back(word == "%" ? *value++ : word);
  return result;
}

/// The number that follows `prefix` in the line.
std::optional<double> number_after(std::string_view line, std::string_view prefix) {
  const std::size_t at = line.find(prefix);
  if (at == std::string_view::npos) return std::nullopt;
  int number = 0;
  const char* begin = line.data() + at + prefix.size();
  if (std::from_chars(begin, line.data() + line.size(), number).ec != std::errc())
    return std::nullopt;
  return number;
}

/// "TEXT [3/67]" is 3 of 67.
std::optional<double> fraction_in(std::string_view line, std::string_view prefix) {
  const auto part = number_after(line, prefix);
  if (!part) return std::nullopt;
  const auto all = number_after(line.substr(line.find(prefix) + prefix.size()), "/");
  return all && *all > 0 ? std::optional(*part / *all) : std::nullopt;
}

// Larger photographs are scaled down: 1600 pixels take twice the time, and add no accuracy.
constexpr int most_pixels = 1200;

}  // namespace

// Measured on one core of a Xeon.
double feature_seconds(const FeatureRequest& request, int threads) {
  const double share = std::min(1.0, double(request.longer_side) / most_pixels);
  return double(request.photographs) * share * share * (request.is_dense ? 1.05 : 0.33) / threads;
}
double match_seconds(std::size_t pairs, double features, int threads) {
  return 70e-6 * features * double(pairs) / threads;
}
double map_seconds(std::size_t photographs) { return 0.25 * double(photographs); }

ColmapStage feature_stage(const ColmapSetup& setup, const std::string& name,
                          const FeatureRequest& request) {
  ColmapStage stage{
      .name = name,
      .title = "finding features",
      .arguments = words(
          "feature_extractor --database_path % --image_path % --image_list_path % "
          "--ImageReader.camera_model % --ImageReader.single_camera % --SiftExtraction.use_gpu 0 "
          "--SiftExtraction.num_threads % --SiftExtraction.max_image_size % "
          "--SiftExtraction.first_octave % --SiftExtraction.max_num_features %",
          {setup.database.string(), setup.images.string(), request.list.string(),
           request.camera_model, request.one_camera ? "1" : "0", std::to_string(setup.threads),
           std::to_string(most_pixels), request.is_dense ? "-1" : "0",
           std::to_string(request.most_features)}),
      .input = request.list,
      .forecast = feature_seconds(request, setup.threads),
      .progress = [](std::string_view line) { return fraction_in(line, "Processed file ["); }};
  // Otherwise an extraction that is resumed would give the other photographs a second camera.
  if (request.camera) {
    stage.arguments.push_back("--ImageReader.existing_camera_id");
    stage.arguments.push_back(std::to_string(*request.camera));
  }
  return stage;
}

namespace {

/// `pairs`: a file with two names in each line.
ColmapStage match_stage(const ColmapSetup& setup, const std::string& name,
                        const std::filesystem::path& pairs, std::size_t pair_count,
                        double features) {
  return {
      .name = name,
      .title = "matching",
      .arguments = words("matches_importer --database_path % --match_list_path % --match_type "
                         "pairs --SiftMatching.use_gpu 0 --SiftMatching.num_threads %",
                         {setup.database.string(), pairs.string(), std::to_string(setup.threads)}),
      .input = pairs,
      .forecast = match_seconds(pair_count, features, setup.threads),
      // The line of a block is complete when the block is.
      .progress = [](std::string_view line) { return fraction_in(line, "Matching block ["); }};
}

}  // namespace

void match_pairs(CameraWork& work, const ColmapSetup& setup, const std::string& name,
                 const PhotoPairs& pairs, const std::vector<std::string>& names, double features) {
  // About twenty portions; a program's start takes as long as some pairs.
  const std::size_t portion = std::clamp<std::size_t>(pairs.size() / 20, 50, 200);
  for (std::size_t first = 0; first < pairs.size(); first += portion) {
    const std::size_t last = std::min(pairs.size(), first + portion);
    const std::string stage = fmt::format("{}-{:04}", name, first / portion + 1);
    std::string lines;
    for (std::size_t i = first; i < last; ++i)
      lines += names[pairs[i].first] + " " + names[pairs[i].second] + "\n";
    const std::filesystem::path file = work / "pairs" / (stage + ".txt");
    write_file(file, lines);
    work.run(match_stage(setup, stage, file, last - first, features));
  }
}

ColmapStage map_stage(const ColmapSetup& setup, const std::string& name,
                      const std::filesystem::path& output, std::size_t photographs,
                      double first_angle) {
  return {.name = name,
          .title = "placing the cameras",
          // The last five take half the time of the defaults, with the same accuracy.
          .arguments = words(
              "mapper --database_path % --image_path % --output_path % --Mapper.num_threads % "
              "--Mapper.init_min_tri_angle % --Mapper.ba_global_images_ratio 1.4 "
              "--Mapper.ba_global_points_ratio 1.4 --Mapper.ba_global_max_num_iterations 20 "
              "--Mapper.ba_global_max_refinements 2 --Mapper.ba_local_max_num_iterations 15",
              {setup.database.string(), setup.images.string(), output.string(),
               std::to_string(setup.threads), fmt::format("{:g}", first_angle)}),
          .input = output,
          .forecast = map_seconds(photographs),
          // The count in brackets begins anew with each model.
          .progress = [photographs](std::string_view line) -> std::optional<double> {
            if (line.find("Registering image #") == std::string_view::npos) return std::nullopt;
            const auto count = number_after(line, "(");
            return count ? std::optional(*count / double(photographs)) : std::nullopt;
          },
          .may_fail = true};
}

ColmapStage point_stage(const ColmapSetup& setup, const std::string& name,
                        const std::filesystem::path& input, const std::filesystem::path& output,
                        std::size_t photographs) {
  return {
      .name = name,
      .title = "placing the points",
      .arguments =
          words("point_triangulator --database_path % --image_path % --input_path % "
                "--output_path % --clear_points 1",
                {setup.database.string(), setup.images.string(), input.string(), output.string()}),
      .input = input,
      .forecast = map_seconds(photographs),
      .progress = [photographs, count = 0](std::string_view line) mutable -> std::optional<double> {
        if (line.find("riangulating image #") == std::string_view::npos) return std::nullopt;
        return ++count / double(photographs);
      }};
}

}  // namespace tureen
