#include "jobs/cameras/known_cameras.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <set>

#include "base/error.hpp"
#include "base/existing_path.hpp"
#include "base/output.hpp"
#include "base/threads/on_all_cores.hpp"
#include "formats/dataset/colmap.hpp"
#include "formats/dataset/dataset.hpp"
#include "image/png.hpp"
#include "jobs/cameras/colmap_stages.hpp"
#include "jobs/cameras/feature_database.hpp"
#include "scene/clip_range.hpp"
#include "scene/region.hpp"

namespace tureen {

namespace {

namespace fs = std::filesystem;

/// Points on a grid of the camera's image, at half, once and twice the distance.
std::vector<glm::dvec3> seen_points(const Camera& camera, double distance) {
  std::vector<glm::dvec3> points;
  const glm::dmat3 axes = camera.world_from_view_rotation();
  constexpr std::array grid{0.15, 0.5, 0.85};
  for (const double x : grid)
    for (const double y : grid)
      for (const double factor : {0.5, 1.0, 2.0})
        points.push_back(camera.eye() +
                         factor * distance *
                             (axes * glm::dvec3((x * camera.width - camera.cx) / camera.fx,
                                                (camera.cy - y * camera.height) / camera.fy, -1)));
  return points;
}

/// The image over black, without alpha, which COLMAP would ignore.
Image8 opaque(Image8 image) {
  for (glm::u8vec4& pixel : image.pixels)
    pixel = glm::u8vec4(glm::u8vec3(glm::uvec3(pixel) * unsigned(pixel.a) / 255u), 255);
  return image;
}

std::string name_of(std::size_t index) { return fmt::format("{:06}.png", index); }

/// The cameras as a model without points, by the numbers of the database.
void write_model(const std::vector<Photograph>& photographs, const FeatureDatabase& database,
                 const fs::path& folder) {
  std::string cameras, images;
  for (const FeatureDatabase::Photo& photo : database.photos()) {
    const auto index = std::size_t(std::atoi(photo.name.c_str()));
    if (index >= photographs.size() || photo.name != name_of(index)) continue;
    const Camera& camera = photographs[index].camera;
    cameras += fmt::format("{} PINHOLE {} {} {} {} {} {}\n", photo.camera, camera.width,
                           camera.height, camera.fx, camera.fy, camera.cx, camera.cy);
    // COLMAP's y points down, its z forward.
    const glm::dmat4 view =
        glm::dmat4(glm::dmat3(1, 0, 0, 0, -1, 0, 0, 0, -1)) * camera.view_from_world;
    const glm::dquat turn = glm::normalize(glm::quat_cast(glm::dmat3(view)));
    images += fmt::format("{} {} {} {} {} {} {} {} {} {}\n\n", photo.number, turn.w, turn.x, turn.y,
                          turn.z, view[3].x, view[3].y, view[3].z, photo.camera, photo.name);
  }
  make_folder(folder);
  write_file(folder / "cameras.txt", cameras);
  write_file(folder / "images.txt", images);
  write_file(folder / "points3D.txt", std::string_view());
}

void write_points(const std::vector<DatasetPoint>& points, const fs::path& file) {
  Output output(file);
  output.write(fmt::format(
      "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty double x\nproperty double "
      "y\nproperty double z\nproperty uchar red\nproperty uchar green\nproperty uchar "
      "blue\nend_header\n",
      points.size()));
  for (const DatasetPoint& point : points) {
    for (int k = 0; k < 3; ++k) output.write_value(point.position[k]);
    output.write_value(point.color);
  }
  output.commit();
}

/// Where the reader finds points. Throws UsageError if it would read none.
fs::path place_of_points(const fs::path& dataset) {
  std::error_code ignored;
  if (!fs::is_directory(dataset, ignored)) return fs::absolute(dataset).parent_path();
  for (const char* name : {"transforms.json", "transforms_train.json"})
    if (fs::exists(dataset / name, ignored)) return dataset;
  if (const auto models = colmap_folders(dataset); !models.empty()) return largest_model(models);
  throw UsageError(dataset.string() + " is a Bundler dataset, whose points are in bundle.out");
}

}  // namespace

PhotoPairs overlapping_pairs(const std::vector<Camera>& cameras, std::size_t most) {
  const glm::dvec3 focus = region_of_cameras(cameras).value_or(Region{}).center;
  const std::size_t count = cameras.size();
  std::vector<std::vector<glm::dvec3>> points;
  std::vector<double> distances;
  for (const Camera& camera : cameras) {
    distances.push_back(std::max(glm::length(focus - camera.eye()), 1e-6));
    points.push_back(seen_points(camera, distances.back()));
  }
  const auto share = [&](std::size_t from, std::size_t to) {
    return double(std::count_if(points[from].begin(), points[from].end(),
                                [&](glm::dvec3 point) { return in_image(cameras[to], point); })) /
           double(points[from].size());
  };
  std::set<std::pair<std::size_t, std::size_t>> pairs;
  for (std::size_t i = 0; i < count; ++i) {
    std::vector<std::pair<double, std::size_t>> others;  // apart, index
    for (std::size_t j = 0; j < count; ++j) {
      const double toward = glm::dot(forward_of(cameras[i]), forward_of(cameras[j]));
      if (j == i || toward < 0.5) continue;
      const double overlap = std::min(share(i, j), share(j, i));
      if (overlap < 0.2) continue;  // a fifth of the image, where features still match
      const double apart = glm::length(cameras[i].eye() - cameras[j].eye()) / distances[i];
      others.emplace_back(apart + std::acos(std::min(toward, 1.0)), j);
    }
    std::sort(others.begin(), others.end());
    // Half of them the nearest, half evenly chosen from the others, which measure depth better.
    for (std::size_t k = 0; k < std::min(most, others.size()); ++k) {
      const std::size_t near = most / 2, rest = others.size() - std::min(near, others.size());
      const std::size_t index =
          k < near || others.size() <= most ? k : near + (k - near) * rest / (most - near);
      pairs.emplace(std::min(i, others[index].second), std::max(i, others[index].second));
    }
  }
  return {pairs.begin(), pairs.end()};
}

PointOutcome add_points(const CameraOptions& options, const CameraEvents& events) {
  require_there(options.dataset);
  const fs::path place = place_of_points(options.dataset);
  const DatasetSummary summary = read_dataset_summary(options.dataset);
  if (!summary.points.empty())
    throw UsageError(fmt::format("{} has {} points; nothing to add", options.dataset.string(),
                                 summary.points.size()));
  int longer = 1;
  std::string inputs;
  for (const DatasetSummary::View& view : summary.train) {
    longer = std::max({longer, view.camera.width, view.camera.height});
    inputs += view.camera.name + "\n";
  }
  const int threads = threads_of(options);
  CameraWork work({.folder = fs::absolute(camera_work_folder(options.dataset)),
                   .colmap = options.colmap,
                   .inputs = inputs},
                  events);
  DatasetOptions reading{.scale = std::min(1.0, 1200.0 / longer), .part = DatasetPart::train};
  reading.progress = [&](double) { work.show("reading photographs"); };
  const std::vector<Photograph> photographs = read_dataset(options.dataset, reading).train;
  const std::size_t count = photographs.size();
  const ColmapSetup setup{
      .database = work / "features.db", .images = work / "images", .threads = threads};
  make_folder(setup.images);
  work.run("images", "preparing photographs", 0.2 * double(count), [&](const auto& progress) {
    on_all_cores(count, progress, [&](std::size_t i, const auto&) {
      write_file(setup.images / name_of(i), encode_png(opaque(photographs[i].image())));
    });
  });

  std::vector<Camera> cameras;
  std::vector<std::string> names;
  for (std::size_t i = 0; i < count; ++i) {
    cameras.push_back(photographs[i].camera);
    names.push_back(name_of(i));
  }
  write_file(work / "features.txt", fmt::format("{}\n", fmt::join(names, "\n")));
  const PhotoPairs pairs = overlapping_pairs(cameras, 20);
  FeatureRequest request{.list = work / "features.txt",
                         .photographs = count,
                         .longer_side = std::min(longer, 1200),
                         .is_dense = longer < 1200,
                         .camera_model = "PINHOLE",
                         .one_camera = false};
  work.expect(feature_seconds(request, threads) + match_seconds(pairs.size(), 2000, threads) +
              map_seconds(count));
  work.run(feature_stage(setup, "features", request));
  const FeatureDatabase database(setup.database);
  match_pairs(work, setup, "matches", pairs, names, 2000);
  write_model(photographs, database, work / "cameras");
  make_folder(work / "model");
  work.run(point_stage(setup, "points", work / "cameras", work / "model", count));

  PointOutcome outcome{.photographs = count, .file = place / "points3D.ply"};
  const ColmapPoints found = read_colmap_points(work / "model");
  for (const ColmapTrack& track : read_colmap_tracks(work / "model"))
    outcome.error_px += track.error / double(found.points.size());
  outcome.points = found.points.size();
  if (found.points.empty())
    throw InputError({options.dataset.string()},
                     "COLMAP finds no point that several photographs show with these cameras");
  write_points(found.points, outcome.file);
  if (!options.keep_work) work.remove();
  return outcome;
}

}  // namespace tureen
