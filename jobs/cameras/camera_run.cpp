#include "jobs/cameras/camera_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <span>
#include <utility>

#include "base/crc32.hpp"
#include "base/error.hpp"
#include "base/existing_path.hpp"
#include "base/input.hpp"
#include "base/output.hpp"
#include "base/platform/machine.hpp"
#include "formats/dataset/dataset.hpp"
#include "jobs/cameras/camera_remarks.hpp"
#include "jobs/cameras/colmap_stages.hpp"
#include "jobs/cameras/photo_neighbors.hpp"
#include "jobs/cameras/photo_set.hpp"
#include "jobs/cameras/video_frames.hpp"

namespace tureen {

namespace {

namespace fs = std::filesystem;

/// Names the photographs of a dataset that this program made.
constexpr const char* source_file = "cameras.txt";

/// Text that differs between sets of photographs.
std::string inputs_of(const fs::path& photographs) {
  if (is_video_file(photographs))
    return fmt::format("{} {}\n", photographs.filename().string(), Input::open(photographs).size());
  const PhotoSet set =
      find_photographs(folder_of_photographs(photographs).value_or(photographs), [](double) {});
  std::string list;
  for (const PhotoFile& photo : set.photos) list += fmt::format("{} {}\n", photo.name, photo.bytes);
  return fmt::format("{} photographs {:08x}\n", set.photos.size(),
                     crc32_of(std::as_bytes(std::span(list))));
}

/// A way to search for cameras: the first one that registers half of the photographs counts.
struct Attempt {
  const char* change = "";  // from the attempt before
  bool is_dense = false;    // more and smaller features, in a database of their own
  std::size_t nearest = 5;  // neighbours of each photograph (likely_pairs)
  double first_angle = 4;   // map_stage()
};
constexpr std::array attempts{Attempt{.first_angle = 16}, Attempt{"with a closer first pair"},
                              Attempt{"with more pairs", false, 10},
                              Attempt{"with more features", true, 10}};

/// Sets with at most so many photographs are often far apart, and cheap to match.
constexpr std::size_t few_photos = 20;

class CameraRun {
 public:
  CameraRun(const CameraOptions& options, const CameraEvents& events)
      : options_(options),
        threads_(threads_of(options)),
        work_({.folder = fs::absolute(camera_work_folder(options.dataset)),
               .colmap = options.colmap,
               .inputs = inputs_of(options.photographs)},
              events),
        events_(events) {}

  CameraOutcome run() {
    collect();
    CameraOutcome outcome{.remarks = set_.remarks};
    for (const Remark& remark : set_.remarks) events_.note(describe(remark));
    if (set_.photos.size() < (options_.accept ? 3 : least_photographs)) {
      outcome.quality = {.photographs = set_.photos.size()};
      outcome.quality.refusals.push_back(
          {&remarks::few_photographs,
           {{"count", set_.photos.size()}, {"least", least_photographs}}});
      work_.remove();
      return outcome;
    }
    link();
    reconstruct(outcome.quality);
    if (outcome.quality.best.empty() || !(outcome.quality.refusals.empty() || options_.accept))
      return outcome;
    write_dataset(outcome.quality.best);
    outcome.is_written = true;
    if (!options_.keep_work) work_.remove();
    return outcome;
  }

 private:
  void collect() {
    fs::path folder = folder_of_photographs(options_.photographs).value_or(options_.photographs);
    if (is_video_file(options_.photographs)) {
      folder = work_ / "frames";
      work_.run("frames", "choosing frames", 30, [&](const auto& progress) {
        std::error_code ignored;
        fs::remove_all(folder, ignored);
        make_folder(folder);
        take_video_frames(options_.photographs, folder, progress);
      });
    }
    set_ = find_photographs(folder, [&](double) { work_.show("reading photographs"); });
    for (const PhotoFile& photo : set_.photos) {
      names_.push_back(photo.name);
      longer_ = std::max({longer_, photo.size.x, photo.size.y});
    }
    groups_ = camera_groups(set_);
  }

  void link() {
    make_folder(work_ / "images");
    for (const PhotoFile& photo : set_.photos) {
      const fs::path link = work_ / "images" / photo.name;
      std::error_code error;
      if (fs::exists(link, error)) continue;
      fs::create_hard_link(photo.path, link, error);
      if (error) {  // an interrupted copy must not look like a whole one
        fs::path part = link;
        part += ".part";
        fs::copy_file(photo.path, part, fs::copy_options::overwrite_existing, error);
        if (!error) fs::rename(part, link, error);
      }
      if (error) throw OutputError({link.string()}, "cannot be written: " + error.message());
    }
  }

  /// Sets the quality of the best attempt.
  void reconstruct(CameraQuality& quality) {
    for (std::size_t i = 0; i < attempts.size(); ++i) {
      if (!is_worth_trying(i, quality)) continue;
      if (i > 0)
        events_.note(fmt::format("{} of {} photographs were registered; trying again {}",
                                 quality.registered, names_.size(), attempts[i].change));
      const Attempt& attempt = attempts[i];
      const bool is_dense = attempt.is_dense || begins_dense();
      find_features(is_dense);
      match(is_dense, attempt.nearest);
      const fs::path folder = work_ / fmt::format("models-{}", i + 1);
      map(is_dense, attempt.first_angle, fmt::format("cameras-{}", i + 1), folder);
      const FeatureDatabase database(setup(is_dense).database);
      CameraQuality found = judge(folder, names_, match_facts(database, longer_));
      if (i == 0 || found.registered > quality.registered) quality = std::move(found);
      if (2 * quality.registered >= names_.size()) break;
    }
  }

  /// Small photographs, and few ones, which are often far apart, need more features at once.
  bool begins_dense() const { return longer_ < 1200 || set_.photos.size() <= few_photos; }
  bool matches_all() const { return set_.photos.size() <= most_photos_for_all_pairs; }

  /// Whether the attempt differs from earlier ones in what was missing.
  bool is_worth_trying(std::size_t index, const CameraQuality& before) const {
    if (index == 0) return true;
    const auto refused = [&](std::initializer_list<const RemarkKind*> kinds) {
      return std::any_of(before.refusals.begin(), before.refusals.end(), [&](const auto& remark) {
        return std::find(kinds.begin(), kinds.end(), remark.kind) != kinds.end();
      });
    };
    using namespace remarks;
    if (refused({&only_turning, &flat_pictures, &no_motion})) return false;
    if (attempts[index].is_dense) return !begins_dense() && !refused({&several_models});
    if (attempts[index].nearest > 5) return !refused({&few_features}) && !matches_all();
    return !refused({&few_features, &several_models});
  }

  ColmapSetup setup(bool is_dense) const {
    return {.database = work_ / (is_dense ? "dense.db" : "features.db"),
            .images = work_ / "images",
            .threads = threads_};
  }

  void find_features(bool is_dense) {
    // Before the features are counted, each photograph is expected to have 2,000.
    const std::size_t count = set_.photos.size();
    work_.expect(
        feature_seconds({.photographs = count, .longer_side = longer_, .is_dense = is_dense},
                        threads_) +
        match_seconds(count * std::min<std::size_t>(count / 2, 15), 2000, threads_) +
        map_seconds(count));
    const std::map<std::string, std::uint32_t> cameras = cameras_of(setup(is_dense).database);
    for (std::size_t i = 0; i < groups_.size(); ++i) {
      const std::string name = fmt::format("features{}-{}", is_dense ? "-dense" : "", i + 1);
      FeatureRequest request{.list = work_ / (name + ".txt"),
                             .photographs = groups_[i].photos.size(),
                             .longer_side = std::max(groups_[i].size.x, groups_[i].size.y),
                             .is_dense = is_dense,
                             .most_features = count <= few_photos ? 4096u : 2048u};
      // Fewer photographs do not determine the eight numbers of OPENCV.
      if (groups_[i].photos.size() < 5) request.camera_model = "SIMPLE_RADIAL";
      std::string names;
      for (const std::size_t photo : groups_[i].photos) {
        names += set_.photos[photo].name + "\n";
        if (const auto at = cameras.find(set_.photos[photo].name); at != cameras.end())
          request.camera = at->second;
      }
      write_file(request.list, names);
      work_.run(feature_stage(setup(is_dense), name, request));
    }
  }

  /// The cameras that an interrupted extraction gave photographs, by name. Removes a database that
  /// was interrupted before it had its tables.
  static std::map<std::string, std::uint32_t> cameras_of(const fs::path& file) {
    std::map<std::string, std::uint32_t> cameras;
    std::error_code error;
    if (fs::exists(file, error)) try {
        for (const auto& photo : FeatureDatabase(file).photos()) cameras[photo.name] = photo.camera;
      } catch (const InputError&) {
        for (const char* suffix : {"", "-wal", "-shm", "-journal"})
          fs::remove(file.string() + suffix, error);
      }
    return cameras;
  }

  PhotoPairs pairs_of(bool is_dense, std::size_t nearest, const FeatureDatabase& database) {
    if (matches_all()) return all_pairs(set_.photos.size());
    if (!neighbors_.count(is_dense)) {
      std::map<std::string, std::uint32_t> numbers;
      for (const auto& photo : database.photos()) numbers[photo.name] = photo.number;
      std::vector<std::vector<FeatureDescriptor>> descriptors;
      for (const PhotoFile& photo : set_.photos)  // as many as the comparison of pairs used
        descriptors.push_back(database.descriptors(numbers[photo.name], 500));
      neighbors_[is_dense] =
          photo_neighbors(descriptors, [&](double) { work_.show("comparing photographs"); });
    }
    return likely_pairs(neighbors_[is_dense], nearest);
  }

  void match(bool is_dense, std::size_t nearest) {
    const FeatureDatabase database(setup(is_dense).database);
    const PhotoPairs pairs = pairs_of(is_dense, nearest, database);
    double features = 0;
    for (const auto& photo : database.photos())
      features += double(photo.features) / double(set_.photos.size());
    work_.expect(match_seconds(pairs.size(), features, threads_) + map_seconds(set_.photos.size()));
    match_pairs(work_, setup(is_dense),
                fmt::format("matches{}-{}", is_dense ? "-dense" : "", nearest), pairs, names_,
                features);
  }

  void map(bool is_dense, double first_angle, const std::string& name, const fs::path& folder) {
    // COLMAP leaves the models of an interrupted run beside new ones.
    std::error_code ignored;
    if (!fs::exists(work_ / "done" / name, ignored)) fs::remove_all(folder, ignored);
    make_folder(folder);
    work_.run(map_stage(setup(is_dense), name, folder, set_.photos.size(), first_angle));
  }

  /// Only the files of the model: COLMAP's own project.ini holds paths of this computer.
  void write_dataset(const fs::path& model) {
    const fs::path made = work_ / "dataset";
    const fs::path target = fs::absolute(options_.dataset);
    try {
      fs::remove_all(made);
      make_folder(made / "sparse/0");
      for (const char* file : {"cameras.bin", "images.bin", "points3D.bin"})
        fs::copy_file(model / file, made / "sparse/0" / file);
      fs::rename(work_ / "images", made / "images");
      write_file(made / source_file, inputs_of(options_.photographs));
      make_folder(target.parent_path());
      fs::rename(made, target);
    } catch (const fs::filesystem_error& error) {
      throw OutputError({target.string()}, "cannot be written: " + error.code().message());
    }
  }

  const CameraOptions& options_;
  int threads_;
  CameraWork work_;
  const CameraEvents& events_;
  PhotoSet set_;
  std::vector<std::string> names_;  // of set_
  std::vector<PhotoGroup> groups_;
  int longer_ = 0;
  std::map<bool, PhotoNeighbors> neighbors_;
};

}  // namespace

int threads_of(const CameraOptions& options) {
  return options.threads > 0 ? options.threads : std::max(1, this_machine().cores);
}

fs::path camera_work_folder(const fs::path& dataset) {
  return (dataset.has_filename() ? dataset : dataset.parent_path()).string() + ".work";
}

bool is_photographs(const fs::path& path) {
  std::error_code ignored;
  if (fs::is_regular_file(path, ignored)) return is_video_file(path);
  return !is_dataset(path) && folder_of_photographs(path).has_value();
}

bool has_cameras(const CameraOptions& options) {
  std::error_code ignored;
  const fs::path source = options.dataset / source_file;
  return is_dataset(options.dataset) && fs::exists(source, ignored) &&
         Input::open(source).read_text() == inputs_of(options.photographs);
}

CameraOutcome find_cameras(const CameraOptions& options, const CameraEvents& events) {
  require_there(options.photographs);
  std::error_code ignored;
  if (fs::exists(options.dataset, ignored) && !fs::is_empty(options.dataset, ignored))
    throw UsageError(options.dataset.string() + " exists", "choose another name");
  return CameraRun(options, events).run();
}

}  // namespace tureen
