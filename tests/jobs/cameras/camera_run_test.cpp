// The search for cameras with a stand-in for COLMAP: stages, resuming, failures and judgement.
#include "jobs/cameras/camera_run.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <cstdlib>
#include <fstream>

#include "base/error.hpp"
#include "base/output.hpp"
#include "base/platform/process.hpp"
#include "formats/dataset/dataset.hpp"
#include "image/png.hpp"
#include "jobs/cameras/camera_remarks.hpp"
#include "jobs/cameras/known_cameras.hpp"

namespace tureen {
namespace camera_run_test {

namespace fs = std::filesystem;

struct Cancelled {};

class CameraSearch : public testing::Test {
 protected:
  void SetUp() override {
    if (!is_on_path("python3")) GTEST_SKIP() << "the stand-in for COLMAP needs python3";
    folder =
        fs::path(testing::TempDir()) /
        (std::string("tureen_") + testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::remove_all(folder);
    fs::create_directories(folder / "photos");
    setenv("STAND_IN_LOG", (folder / "calls").c_str(), 1);
    behave("");
    options.photographs = folder / "photos";
    options.dataset = folder / "dataset";
    options.colmap = TUREEN_SOURCE_DIR "/tests/jobs/cameras/colmap_stand_in.py";
    options.threads = 2;
    events.progress = [](const char*, double fraction, double) {
      EXPECT_GE(fraction, 0);
      EXPECT_LE(fraction, 1);
    };
    events.note = [](const std::string&) {};
  }
  void TearDown() override { fs::remove_all(folder); }

  static void behave(const std::string& words) { setenv("STAND_IN", words.c_str(), 1); }

  void take(int first, int last) const {
    for (int i = first; i <= last; ++i) {
      const Image8 image(64, 48, glm::u8vec4(i, 100, 100, 255));
      write_file(folder / "photos" / ("photo " + std::to_string(i) + ".png"), encode_png(image));
    }
  }

  CameraOutcome find() const { return find_cameras(options, events); }

  /// The commands that were called, in order.
  std::vector<std::string> calls() const {
    std::vector<std::string> result;
    std::ifstream file(folder / "calls");
    for (std::string line; std::getline(file, line);)
      result.push_back(line.substr(0, line.find(' ')));
    return result;
  }
  void forget_calls() const { fs::remove(folder / "calls"); }

  /// The codes of the refusals.
  static std::vector<std::string> refusals(const CameraOutcome& outcome) {
    std::vector<std::string> codes;
    for (const Remark& remark : outcome.quality.refusals) codes.emplace_back(remark.kind->code);
    return codes;
  }

  fs::path folder;
  CameraOptions options;
  CameraEvents events;
};

TEST_F(CameraSearch, MakesADatasetThatTheReaderReads) {
  take(1, 12);
  const CameraOutcome outcome = find();
  EXPECT_TRUE(outcome.is_written);
  EXPECT_THAT(refusals(outcome), testing::IsEmpty());
  EXPECT_EQ(outcome.quality.registered, 12u);
  EXPECT_THAT(outcome.quality.models, testing::ElementsAre(12));
  EXPECT_EQ(outcome.quality.points, 360u);
  EXPECT_NEAR(outcome.quality.error_px, 0.5, 1e-12);  // a sum of 360 equal parts
  EXPECT_DOUBLE_EQ(outcome.quality.photographs_per_point, 3);
  EXPECT_DOUBLE_EQ(outcome.quality.points_per_photograph, 30);
  const Dataset dataset = read_dataset(options.dataset);
  EXPECT_EQ(dataset.train.size() + dataset.test.size(), 12u);
  EXPECT_EQ(dataset.points.size(), 360u);
  EXPECT_FALSE(fs::exists(camera_work_folder(options.dataset)));
  EXPECT_TRUE(has_cameras(options));
  EXPECT_THAT(calls(), testing::ElementsAre("feature_extractor", "matches_importer",
                                            "matches_importer", "mapper"));
  take(13, 13);
  EXPECT_FALSE(has_cameras(options));
}

TEST_F(CameraSearch, ContinuesWhereItWasCancelled) {
  take(1, 12);
  for (const std::string command : {"feature_extractor", "matches_importer", "mapper"}) {
    forget_calls();
    behave("slow=" + command);
    const auto reported = events.progress;
    events.progress = [&](const char*, double, double) {
      if (const auto begun = calls(); !begun.empty() && begun.back() == command) throw Cancelled();
    };
    EXPECT_THROW(find(), Cancelled);
    events.progress = reported;
    behave("");
    EXPECT_FALSE(fs::exists(options.dataset));
    const std::size_t before = calls().size();
    EXPECT_TRUE(find().is_written);
    // The stage that was cancelled is repeated, and none before it.
    ASSERT_EQ(calls().size(), 5u) << command;
    EXPECT_EQ(calls()[before], command);
    EXPECT_EQ(read_dataset_summary(options.dataset).train.size(), 10u);
    fs::remove_all(options.dataset);
  }
}

TEST_F(CameraSearch, AfterAKilledExtractionAllPhotographsHaveOneCamera) {
  take(1, 12);
  behave("kill=feature_extractor");
  EXPECT_THROW(find(), Error);
  behave("");
  options.keep_work = true;
  EXPECT_TRUE(find().is_written);
  for (const auto& photo : FeatureDatabase(folder / "dataset.work/dense.db").photos())
    EXPECT_EQ(photo.camera, 1u);
}

TEST_F(CameraSearch, OtherPhotographsStartAgain) {
  take(1, 12);
  behave("kill=mapper");
  EXPECT_THROW(find(), Error);
  take(13, 13);
  behave("");
  forget_calls();
  EXPECT_EQ(find().quality.registered, 13u);
  EXPECT_THAT(calls(), testing::Contains("feature_extractor"));
}

TEST_F(CameraSearch, AFailedStageNamesItsLogAndReason) {
  take(1, 12);
  behave("fail=matches_importer");
  try {
    find();
    FAIL();
  } catch (const Error& error) {
    EXPECT_THAT(error.reason(), testing::HasSubstr("failed as asked"));
    EXPECT_TRUE(fs::exists(error.position().file));
  }
}

TEST_F(CameraSearch, MissingColmapIsReportedWithACommand) {
  take(1, 12);
  options.colmap = "no-such-colmap";
  EXPECT_THROW(find(), UsageError);
  const std::string path = std::getenv("PATH");
  setenv("PATH", "/nonexistent", 1);
  options.colmap = "colmap";
  try {
    find();
    ADD_FAILURE();
  } catch (const UsageError& error) {
    EXPECT_THAT(error.hint(), testing::HasSubstr("apt-get install"));
  }
  setenv("PATH", path.c_str(), 1);
}

TEST_F(CameraSearch, RefusesWhatDeterminesNoCameras) {
  take(1, 12);
  const std::pair<const char*, const RemarkKind*> cases[] = {
      {"blank", &remarks::few_features},        {"flat", &remarks::flat_pictures},
      {"plane", &remarks::flat_pictures},       {"turning", &remarks::only_turning},
      {"still", &remarks::no_motion},           {"split", &remarks::few_registered},
      {"register=5", &remarks::few_registered}, {"fail=mapper", &remarks::few_registered}};
  for (const auto& [words, kind] : cases) {
    behave(words);
    fs::remove_all(folder / "dataset.work");
    const CameraOutcome outcome = find();
    EXPECT_FALSE(outcome.is_written) << words;
    EXPECT_THAT(refusals(outcome), testing::ElementsAre(kind->code)) << words;
    EXPECT_FALSE(fs::exists(options.dataset)) << words;
  }
}

TEST_F(CameraSearch, SeveralModelsAreNamedAndMayBeAccepted) {
  take(1, 30);
  behave("split");
  const CameraOutcome refused = find();
  EXPECT_THAT(refused.quality.models, testing::ElementsAre(16, 14));
  EXPECT_THAT(refusals(refused), testing::ElementsAre(remarks::several_models.code));
  forget_calls();
  options.accept = true;
  EXPECT_TRUE(find().is_written);
  EXPECT_THAT(calls(), testing::IsEmpty());  // nothing is computed again
  EXPECT_EQ(read_dataset_summary(options.dataset).train.size(), 14u);
}

TEST_F(CameraSearch, TooFewPhotographsAreRefusedBeforeAnyWork) {
  take(1, 5);
  fs::copy_file(folder / "photos/photo 1.png", folder / "photos/copy 1.png");
  const CameraOutcome outcome = find();
  EXPECT_THAT(refusals(outcome), testing::ElementsAre(remarks::few_photographs.code));
  ASSERT_EQ(outcome.remarks.size(), 1u);
  EXPECT_EQ(outcome.remarks[0].kind, &remarks::photographs_copied);
  EXPECT_THAT(calls(), testing::IsEmpty());
  EXPECT_FALSE(fs::exists(folder / "dataset.work"));
}

TEST_F(CameraSearch, LargeSetsMatchNeighborsOnly) {
  take(1, 60);
  options.keep_work = true;
  EXPECT_TRUE(find().is_written);
  // Photographs up to 7 apart share places. All offsets of a series are matched, not all 1,770
  // pairs. (The stand-in's places are in the order of names, that of the series of numbers.)
  const auto pairs = FeatureDatabase(folder / "dataset.work/dense.db").pairs();
  EXPECT_GE(pairs.size(), 200u);
  EXPECT_LE(pairs.size(), 1000u);
}

TEST_F(CameraSearch, EachSizeHasACamera) {
  take(1, 12);
  for (int i = 1; i <= 6; ++i)
    write_file(folder / "photos" / ("tall" + std::to_string(i) + ".png"),
               encode_png(Image8(48, 64, glm::u8vec4(i, 0, 0, 255))));
  options.keep_work = true;
  EXPECT_TRUE(find().is_written);
  for (const auto& photo : FeatureDatabase(folder / "dataset.work/dense.db").photos())
    EXPECT_EQ(photo.camera, photo.name.starts_with("tall") ? 1u : 2u) << photo.name;
}

TEST_F(CameraSearch, KnownCamerasGetPoints) {
  take(1, 12);
  EXPECT_TRUE(find().is_written);
  fs::remove(options.dataset / "sparse/0/points3D.bin");
  ASSERT_TRUE(read_dataset_summary(options.dataset).points.empty());
  CameraOptions known = options;
  known.photographs.clear();
  known.threads = 2;
  behave("kill=matches_importer");
  EXPECT_THROW(add_points(known, events), Error);
  EXPECT_FALSE(fs::exists(options.dataset / "sparse/0/points3D.ply"));
  behave("");
  forget_calls();
  const PointOutcome outcome = add_points(known, events);
  EXPECT_EQ(calls().front(), "matches_importer");
  EXPECT_EQ(calls().back(), "point_triangulator");
  EXPECT_EQ(outcome.photographs, 10u);  // two of the twelve are test views
  EXPECT_EQ(outcome.points, 300u);
  EXPECT_FALSE(fs::exists(camera_work_folder(options.dataset)));
  const DatasetSummary summary = read_dataset_summary(options.dataset);
  ASSERT_EQ(summary.points.size(), 300u);
  EXPECT_NEAR(summary.points[1].position.x, std::sin(12.9), 1e-15);  // stored as a double
  EXPECT_EQ(summary.points[1].color, glm::u8vec3(200, 100, 50));
  EXPECT_THROW(add_points(known, events), UsageError);  // it has points now
}

TEST(OverlappingPairs, AreNeighborsThatLookTheSameWay) {
  std::vector<Camera> cameras;
  for (int i = 0; i < 36; ++i) {
    const double angle = i * std::acos(-1.0) / 18;
    cameras.push_back(
        look_at({4 * std::cos(angle), 4 * std::sin(angle), 1}, {0, 0, 0}, {0, 0, 1}, 0.8, 64, 48));
  }
  const PhotoPairs pairs = overlapping_pairs(cameras, 8);
  EXPECT_GE(pairs.size(), 36u * 4);
  EXPECT_LE(pairs.size(), 36u * 8);
  for (const auto& [first, second] : pairs) {
    const std::size_t apart = second - first;
    EXPECT_LE(std::min(apart, 36 - apart), 6u);  // 60 degrees
  }
  EXPECT_THAT(pairs, testing::Contains(std::pair(std::size_t(0), std::size_t(35))));
}

}  // namespace camera_run_test
}  // namespace tureen
