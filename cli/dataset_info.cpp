#include "cli/dataset_info.hpp"

#include <fmt/format.h>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <map>

#include "base/decimal_text.hpp"
#include "base/error.hpp"
#include "base/output.hpp"
#include "cli/files/camera_plot.hpp"
#include "cli/options/output_argument.hpp"
#include "cli/report.hpp"
#include "cli/table.hpp"
#include "formats/dataset/camera_file.hpp"
#include "formats/dataset/colmap.hpp"
#include "formats/dataset/dataset.hpp"

namespace tureen::cli {

namespace {

struct PositionBounds {
  glm::dvec3 low{std::numeric_limits<double>::infinity()};
  glm::dvec3 high{-std::numeric_limits<double>::infinity()};

  void add(glm::dvec3 position) {
    position += 0.0;  // -0 becomes 0
    low = glm::min(low, position);
    high = glm::max(high, position);
  }
  double diagonal() const { return glm::length(high - low); }
  std::string text() const { return vector_text(low) + " to " + vector_text(high); }
  Json json() const { return {{"low", {low.x, low.y, low.z}}, {"high", {high.x, high.y, high.z}}}; }
};

/// The counted and bounded contents of a dataset.
struct DatasetFacts {
  std::vector<Camera> cameras;                     // train, then test
  std::map<std::pair<int, int>, int> image_sizes;  // width, height: photographs
  int pinhole = 0, distorted = 0, fisheye = 0, masked = 0;
  PositionBounds eyes, points;

  explicit DatasetFacts(const DatasetSummary& dataset) {
    for (const auto* views : {&dataset.train, &dataset.test})
      for (const DatasetSummary::View& view : *views) {
        cameras.push_back(view.camera);
        ++image_sizes[{view.camera.width, view.camera.height}];
        ++(view.lens == LensKind::pinhole   ? pinhole
           : view.lens == LensKind::fisheye ? fisheye
                                            : distorted);
        masked += view.has_mask;
        eyes.add(view.camera.eye());
      }
    for (const DatasetPoint& point : dataset.points) points.add(point.position);
  }
};

std::string sizes_text(const DatasetFacts& facts) {
  constexpr std::size_t most = 4;
  std::string text;
  std::size_t shown = 0;
  for (const auto& [size, count] : facts.image_sizes) {
    if (shown++ == most) {
      text += fmt::format(" and {} other sizes", facts.image_sizes.size() - most);
      break;
    }
    text += fmt::format("{}{} x {}", text.empty() ? "" : ", ", size.first, size.second);
    if (facts.image_sizes.size() > 1) text += fmt::format(" ({})", count);
  }
  return text;
}

std::string lenses_text(const DatasetFacts& facts) {
  std::string text;
  for (const auto& [count, what] :
       {std::pair{facts.pinhole, "without distortion"},
        std::pair{facts.distorted, "with distortion, to be removed"},
        std::pair{facts.fisheye, "with a fisheye lens, to be turned into pinhole images"}})
    if (count > 0) text += fmt::format("{}{} {}", text.empty() ? "" : "; ", count, what);
  return text;
}

void say_dataset(const DatasetInfoOptions& options, const DatasetSummary& dataset,
                 const DatasetFacts& facts) {
  Table table({"", "<"});
  table.row({"photographs",
             fmt::format("{} to train on, {} to test", dataset.train.size(), dataset.test.size())});
  table.row({"image size", sizes_text(facts)});
  table.row({"lenses", lenses_text(facts)});
  if (facts.masked > 0) table.row({"masks", std::to_string(facts.masked)});
  table.row({"cameras in", facts.eyes.text()});
  table.row({"extent", fmt::format("{:.6g}, the diagonal of this box", facts.eyes.diagonal())});
  table.row({"points", dataset.points.empty() ? "none" : counted(dataset.points.size())});
  if (!dataset.points.empty()) table.row({"points in", facts.points.text()});
  table.row({"up", vector_text(dataset.up)});
  say_list(options.path + ": a dataset", table.lines());
  say_list("Notes:", notes_of(dataset.remarks));
}

/// If the photographs of a COLMAP model are missing, the error describes the model.
DatasetSummary summary_of(const std::string& path) {
  try {
    return read_dataset_summary(path);
  } catch (const InputError& error) {
    const auto models = colmap_folders(path);
    if (models.empty()) throw;
    const ColmapModel model = read_colmap(largest_model(models));
    throw InputError(
        error.position(),
        fmt::format("a COLMAP model with {}, {} and {}, which is no dataset without "
                    "its photographs: {}",
                    counted(model.cameras.size(), "camera"), counted(model.images.size(), "image"),
                    counted(model.points.points.size(), "point"), error.reason()),
        "put the photographs into the folder images beside it, or draw its cameras "
        "with tureen render SCENE --camera FOLDER");
  }
}

Json dataset_json(const DatasetInfoOptions& options, const DatasetSummary& dataset,
                  const DatasetFacts& facts) {
  Json sizes = Json::array();
  for (const auto& [size, count] : facts.image_sizes)
    sizes.push_back({{"width", size.first}, {"height", size.second}, {"photographs", count}});
  return {
      {"file", options.path},
      {"train_photographs", dataset.train.size()},
      {"test_photographs", dataset.test.size()},
      {"image_sizes", std::move(sizes)},
      {"lenses",
       {{"pinhole", facts.pinhole}, {"distorted", facts.distorted}, {"fisheye", facts.fisheye}}},
      {"masks", facts.masked},
      {"camera_bounds", facts.eyes.json()},
      {"extent", facts.eyes.diagonal()},
      {"points", dataset.points.size()},
      {"point_bounds", dataset.points.empty() ? Json() : facts.points.json()},
      {"up", {dataset.up.x, dataset.up.y, dataset.up.z}},
      {"cameras", Json::parse(cameras_to_json(facts.cameras)).at("cameras")},
      {"notes", notes_of(dataset.remarks)},
      {"remarks", remarks_json(dataset.remarks)},
      {"output", options.plot.empty() ? Json() : Json(options.plot)}};
}

}  // namespace

void inform_of_dataset(const DatasetInfoOptions& options) {
  if (!options.plot.empty()) {
    if (std::filesystem::path(options.plot).extension() != ".svg")
      throw UsageError("'" + options.plot + "' does not end in .svg; the plot is an SVG file");
    if (std::filesystem::is_regular_file(options.path))
      require_not_input(options.plot, options.path);
    require_writable_file(options.plot);
  }
  const DatasetSummary dataset = summary_of(options.path);
  const DatasetFacts facts(dataset);
  say_dataset(options, dataset, facts);
  if (!options.plot.empty()) {
    write_file(options.plot, camera_plot(dataset));
    say("wrote " + options.plot);
  }
  if (options.json) print_json(dataset_json(options, dataset, facts));
}

}  // namespace tureen::cli
