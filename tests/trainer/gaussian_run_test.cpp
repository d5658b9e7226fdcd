// Whole runs of Gaussians: their first splats, their forecast, and their files.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <glm/geometric.hpp>

#include "base/error.hpp"
#include "base/existing_path.hpp"
#include "base/input.hpp"
#include "base/platform/scratch_file.hpp"
#include "formats/scene_file.hpp"
#include "tests/support/errors.hpp"
#include "trainer/common/training_log.hpp"
#include "trainer/splats/gaussians/gaussian_training.hpp"
#include "trainer/splats/splat_forecast.hpp"
#include "trainer/splats/splat_initialise.hpp"
#include "trainer/splats/splat_training.hpp"

namespace tureen::trainer {
namespace gaussian_run_test {

namespace fs = std::filesystem;
namespace row = splatting::gaussian_row;

constexpr int size = 24;

/// A bright disc on black, from around a centre far from the origin: 5 training views, a test view.
Dataset disc_dataset(glm::dvec3 center = {1000, -2000, 500}) {
  Dataset dataset;
  for (int k = 0; k < 6; ++k) {
    const double turn = k * 1.05;
    Photograph view;
    view.camera = look_at(center + glm::dvec3(4 * std::cos(turn), 4 * std::sin(turn), 1), center,
                          {0, 0, 1}, 0.6, size, size);
    view.camera.name = "r_" + std::to_string(k);
    Image8 image(size, size, glm::u8vec4(0, 0, 0, 255));
    for (int y = 0; y < size; ++y)
      for (int x = 0; x < size; ++x)
        if (std::hypot(x - 11.5, y - 11.5) < 6) image.at(x, y) = {240, 160, 80, 255};
    view.image = std::move(image);
    (k < 5 ? dataset.train : dataset.test).push_back(view);
  }
  dataset.up = {0, 0, 1};
  return dataset;
}

GaussianParameters first(const Dataset& dataset, const GaussianConfig& config,
                         const Scene* start = nullptr) {
  Random random(5);
  return initial_splats<GaussianTraining>(dataset, config, region_of_interest(dataset), start,
                                          random);
}

bool all_finite(const GaussianParameters& parameters) {
  for (std::size_t r = 0; r < parameters.rows(); ++r)
    for (std::size_t i = 0; i < parameters.count(); ++i)
      if (!std::isfinite(parameters.trained(r)[i]) || !std::isfinite(parameters.drawn.row(r)[i]))
        return false;
  return true;
}

TEST(FirstGaussians, AreRandomWithoutPoints) {
  const Dataset dataset = disc_dataset();
  const GaussianParameters some = first(dataset, {{.first_splats = 70}});
  EXPECT_EQ(some.count(), 70u);
  EXPECT_TRUE(all_finite(some));
  EXPECT_EQ(first(dataset, {{.max_splats = 30, .first_splats = 70}}).count(), 30u);
  EXPECT_THROW(first(dataset, {{.initialisation = Initialisation::points}}), InputError);
}

TEST(FirstGaussians, AreAtPointsHoweverFew) {
  for (const std::size_t count : {1u, 2u, 50u}) {
    Dataset dataset = disc_dataset();
    Random random(3);
    for (std::size_t i = 0; i < count; ++i)
      dataset.points.push_back(
          {glm::dvec3(1000, -2000, 500) + 0.3 * random.in_ball(), {255, 0, 51}});
    const GaussianParameters splats = first(dataset, {{.first_splats = 20}});
    ASSERT_EQ(splats.count(), std::max<std::size_t>(count, 20)) << count;
    EXPECT_TRUE(all_finite(splats)) << count;
    const Region region = region_of_interest(dataset);
    for (int axis = 0; axis < 3; ++axis)
      // Relative to the region's centre, in single precision.
      EXPECT_NEAR(splats.drawn.row(row::x + std::size_t(axis))[0],
                  dataset.points[0].position[axis] - region.center[axis], 1e-5);
    // The colour max(0, 1/2 + Y0 c), with Y0 in single precision.
    const double y0 = 0.28209479;
    EXPECT_NEAR(0.5 + y0 * splats.drawn.row(row::harmonics)[0], 1.0, 1e-6);
    EXPECT_NEAR(0.5 + y0 * splats.drawn.row(row::harmonics + 1)[0], 0.0, 1e-6);
    EXPECT_NEAR(0.5 + y0 * splats.drawn.row(row::harmonics + 2)[0], 0.2, 1e-6);
  }
}

TEST(FirstGaussians, HaveTheMeanDistanceToThreeNeighbours) {
  Dataset dataset = disc_dataset({0, 0, 0});
  for (const double x : {0.0, 0.1, 0.3, 0.6}) dataset.points.push_back({{x, 0, 0}, {9, 9, 9}});
  const GaussianParameters splats = first(dataset, {{.first_splats = 4}});
  EXPECT_NEAR(splats.drawn.row(row::scale_y)[0], (0.1 + 0.3 + 0.6) / 3, 1e-6);
  EXPECT_NEAR(splats.drawn.row(row::scale_y)[3], (0.3 + 0.5 + 0.6) / 3, 1e-6);
}

TEST(FirstGaussians, OfCoincidentPointsHaveASize) {
  Dataset dataset = disc_dataset();
  for (int i = 0; i < 9; ++i) dataset.points.push_back({{1000, -2000, 500}, {9, 9, 9}});
  const GaussianConfig config{{.first_splats = 9}};
  const GaussianParameters splats = first(dataset, config);
  const double half_side = region_of_interest(dataset).half_side;
  ASSERT_EQ(splats.count(), 9u);
  EXPECT_TRUE(all_finite(splats));
  EXPECT_NEAR(splats.drawn.row(row::scale_x)[0], double(config.min_scale) * half_side,
              1e-5 * half_side);
}

TEST(FirstGaussians, LieOnTheTrianglesOfAScene) {
  const Dataset dataset = disc_dataset({0, 0, 0});
  TriangleSoup soup;
  // Areas 1 and 3, in the plane z = 0.5.
  soup.positions = {{0, 0, 0.5}, {2, 0, 0.5}, {0, 1, 0.5}, {0, 0, 0.5}, {-2, 0, 0.5}, {0, 3, 0.5}};
  soup.triangles = {{0, 1, 2}, {3, 4, 5}};
  soup.appearance = FaceColors{{glm::u8vec4(255, 0, 0, 255), glm::u8vec4(0, 255, 0, 255)}};
  Scene scene = scene_of(soup);
  const GaussianConfig config{{.first_splats = 4000, .initialisation = Initialisation::mesh}};
  const GaussianParameters splats = first(dataset, config, &scene);
  ASSERT_EQ(splats.count(), 4000u);
  const Region region = region_of_interest(dataset);
  std::size_t large = 0;
  for (std::size_t i = 0; i < splats.count(); ++i) {
    EXPECT_NEAR(splats.drawn.row(row::z)[i] + region.center.z, 0.5, 1e-6);
    const bool left = splats.drawn.row(row::x)[i] + region.center.x < 0;
    const bool green = splats.drawn.row(row::harmonics + 1)[i] > 0;
    EXPECT_EQ(left, green);
    large += left;
  }
  // 3,000 expected; the standard deviation is sqrt(4000 * 3/4 * 1/4) = 27. Five of them.
  EXPECT_NEAR(double(large), 3000, 137);
}

TEST(FirstGaussians, OfASceneAreTakenAsTheyAre) {
  const Dataset dataset = disc_dataset();
  Random random(1);
  const GaussianParameters made =
      random_splats<GaussianTraining>({{.first_splats = 12, .degree = 1}}, {}, random);
  Scene scene = scene_of(made.splats(), {1000, -2000, 500});
  const GaussianConfig config{{.degree = 2, .initialisation = Initialisation::mesh}};
  const GaussianParameters splats = first(dataset, config, &scene);
  ASSERT_EQ(splats.count(), 12u);
  EXPECT_EQ(splats.degree, 2);
  const glm::dvec3 shift = glm::dvec3(1000, -2000, 500) - region_of_interest(dataset).center;
  for (std::size_t i = 0; i < 12; ++i) {
    // Rounding of single precision.
    EXPECT_NEAR(splats.drawn.row(row::x)[i], made.drawn.row(row::x)[i] + shift.x, 1e-5);
    EXPECT_NEAR(splats.drawn.row(row::opacity)[i], made.drawn.row(row::opacity)[i], 1e-6);
    EXPECT_NEAR(splats.drawn.row(row::scale_z)[i], made.drawn.row(row::scale_z)[i], 1e-6);
  }
  std::get<Gaussians>(std::get<Splats>(scene.layers[0].primitives).kernel).flat = true;
  EXPECT_THROW(first(dataset, config, &scene), InputError);
}

TEST(SplatForecast, LimitsTheSplatsToTheMemory) {
  const Dataset dataset = disc_dataset();
  GaussianConfig config{{.max_splats = 100'000}};
  const std::uint64_t all = splat_memory(config, dataset);
  EXPECT_EQ(max_splats_within(all + 1000, config, dataset), 100'000u);
  EXPECT_EQ(max_splats_within(2 * all, config, dataset), 100'000u);
  const auto half = max_splats_within(all / 2, config, dataset);
  ASSERT_TRUE(half);
  EXPECT_LT(*half, 51'000u);
  config.max_splats = *half;
  EXPECT_LE(splat_memory(config, dataset), all / 2);
  EXPECT_FALSE(max_splats_within(100'000, config, dataset));
  Dataset moved = disc_dataset();
  for (auto* views : {&moved.train, &moved.test})
    for (Photograph& view : *views) view.move_to(std::make_shared<ScratchFile>());
  const std::uint64_t photographs = 6 * size * size * 4;
  EXPECT_EQ(splat_memory(config, moved) + photographs, splat_memory(config, dataset));
  EXPECT_EQ(splat_memory(config, dataset, PhotographPlace::in_file), splat_memory(config, moved));
}

TEST(SplatForecast, FitsTheStepsToTheTime) {
  GaussianConfig config;
  config.half_size_until = 0;
  EXPECT_EQ(fitted_steps(config, 0, 60, 0.1), 600);
  EXPECT_EQ(fitted_steps(config, 100, 30, 0.1), 400);
  EXPECT_EQ(fitted_steps(config, 100, -10, 0.1), 101);  // late: the next step is the last one
  EXPECT_EQ(fitted_steps(config, 0, 1e9, 1e-9), 10'000'000);
  config.half_size_until = 0.4;
  for (const int done : {0, 100, 300, 700}) {
    config.steps = fitted_steps(config, done, 50, 0.1);
    EXPECT_NEAR(remaining_work(config, done), 500, 0.6) << done;  // to the nearest step
  }
}

TEST(SplatForecast, FollowsTheGrowthOfTheNumber) {
  GaussianConfig config{{.steps = 100, .max_splats = 4000}};
  config.densify_every = 20;
  config.densify_until = 1;
  config.growth = 1;
  config.half_size_until = 0;
  // 1,000, 2,000 and three times 4,000 splats.
  EXPECT_DOUBLE_EQ(growth_of_work(config, 0, 1000), 3);
  EXPECT_DOUBLE_EQ(growth_of_work(config, 0, 4000), 1);
  EXPECT_DOUBLE_EQ(growth_of_work(config, 50, 5000), 1);
  // The first two fifths with half the sides, which take less time.
  config.half_size_until = 0.4;
  EXPECT_DOUBLE_EQ(growth_of_work(config, 0, 1000),
                   (3 * half_size_work + 12) / (2 * half_size_work + 3));
}

struct Files {
  fs::path folder;
  Files() {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    folder = fs::path(testing::TempDir()) / (std::string("tureen_run_") + info->name());
    fs::remove_all(folder);
    fs::create_directories(folder);
  }
  ~Files() { fs::remove_all(folder); }
};

GaussianRequest request(const Files& files, const GaussianConfig& config) {
  GaussianRequest request;
  request.config = config;
  request.run.name = "disc";
  request.run.threads = 2;
  request.run.session.checkpoint = files.folder / "disc.checkpoint";
  request.run.session.log = files.folder / "disc.jsonl";
  return request;
}

TEST(GaussianTraining, LearnsTheDiscFarFromTheOrigin) {
  const Files files;
  Dataset dataset = disc_dataset();
  GaussianRequest asked = request(files, {{.steps = 400,
                                           .max_splats = 300,
                                           .first_splats = 200,
                                           .densify_every = 40,
                                           .background = {0, 0, 0}}});
  SplatStart start;
  asked.begun = [&](const SplatStart& given) { start = given; };
  asked.run.session.plan = [] { return R"({"text":["400 steps"]})"; };
  double forecast = 0;  // after 100 steps
  asked.run.session.progress = [&](const SessionStatus& now) {
    if (now.step == 100) forecast = now.seconds_left;
  };
  Scene scene;
  asked.run.finished = [&](const Scene& finished) { scene = finished; };
  const SplatResult result = train_splats(dataset, std::move(asked));
  EXPECT_EQ(start.splats, 200u);
  EXPECT_EQ(start.threads, 2);
  // The machine may be busy for a part of the time.
  EXPECT_GT(forecast, 0.2 * result.run.seconds);
  EXPECT_LT(forecast, 5 * result.run.seconds);
  EXPECT_EQ(result.steps, 400);
  EXPECT_EQ(result.non_finite, 0u);
  // 21.0 dB when written. Other processors round differently.
  EXPECT_GT(result.run.test_psnr_db.value(), 19);
  EXPECT_EQ(scene.cameras.size(), 5u);
  EXPECT_EQ(scene.info.source, "Tureen trainer, 400 steps");
  const Layer& layer = only_layer(scene);
  EXPECT_LT(glm::distance(origin_of(layer), glm::dvec3(1000, -2000, 500)), 1);
  EXPECT_EQ(count(std::get<Splats>(layer.primitives)), result.primitives.count);
  EXPECT_EQ(defect(std::get<Splats>(layer.primitives)).value_or(""), "");
  TrainingLogTail tail(files.folder / "disc.jsonl");
  tail.update();
  EXPECT_EQ(tail.plan(), std::vector<std::string>{"400 steps"});
  const auto& log = tail.records();
  EXPECT_GT(log.front().seconds_left, 0);
  EXPECT_EQ(log.back().seconds_left, 0);
  EXPECT_EQ(log.back().step, 400);
  EXPECT_EQ(log.back().primitives.kind, PrimitiveKind::splats);
  EXPECT_GT(log.back().train_psnr_db, 15);
  EXPECT_TRUE(log.back().test_psnr_db);
}

TEST(GaussianTraining, FitsItsStepsToTheMinutesAndStoresThem) {
  const Files files;
  constexpr double seconds = 20;
  struct Stop {};
  Dataset dataset = disc_dataset();
  // `steps` counts for nothing.
  GaussianRequest asked = request(files, {{.steps = 3,
                                           .max_splats = 300,
                                           .first_splats = 200,
                                           .background = {0, 0, 0},
                                           .minutes = seconds / 60}});
  double now = 0;
  asked.run.session.clock = [&] { return now; };
  // Until all fits are over.
  asked.run.session.progress = [&](const SessionStatus& status) {
    if (!status.fits_steps) throw Stop();
    now += 0.1;
  };
  EXPECT_THROW(train_splats(dataset, std::move(asked)), Stop);
  EXPECT_NEAR(now, 0.95 * seconds, 0.2);
  GaussianCheckpoint stored =
      read_splat_checkpoint<GaussianCheckpoint>(open_existing(files.folder / "disc.checkpoint"));
  const int steps = stored.config.steps;
  EXPECT_NEAR(steps, seconds / 0.1, 3);
  EXPECT_LT(stored.state.step, steps);

  Dataset again = disc_dataset();
  GaussianRequest resumed = request(files, stored.config);
  resumed.checkpoint = std::move(stored);
  EXPECT_EQ(train_splats(again, std::move(resumed)).steps, steps);
}

void move_to_file(Dataset& dataset) {
  const auto file = std::make_shared<ScratchFile>();
  for (auto* views : {&dataset.train, &dataset.test})
    for (Photograph& view : *views) view.move_to(file);
}

TEST(GaussianTraining, IsTheSameFromPhotographsInAFile) {
  const GaussianConfig config{{.steps = 60, .max_splats = 300, .first_splats = 200}};
  std::vector<std::vector<std::byte>> files;
  enum { in_memory, in_file, resumed };
  for (const int kind : {in_memory, in_file, resumed}) {
    const Files run;
    struct Stop {};
    const auto train = [&](bool resumes, int stop_at) {
      Dataset dataset = disc_dataset();
      if (kind != in_memory) move_to_file(dataset);
      GaussianRequest asked = request(run, config);
      if (resumes)
        asked.checkpoint =
            read_splat_checkpoint<GaussianCheckpoint>(open_existing(asked.run.session.checkpoint));
      asked.run.session.progress = [&](const SessionStatus& now) {
        if (now.step == stop_at) throw Stop();
      };
      asked.run.finished = [&](const Scene& scene) { write_scene(scene, run.folder / "disc.glb"); };
      train_splats(dataset, std::move(asked));
    };
    // In the first steps, the images have half their sides.
    if (kind == resumed) {
      EXPECT_THROW(train(false, 25), Stop);
    }
    train(kind == resumed, -1);
    files.push_back(Input::open(run.folder / "disc.glb").read_rest());
  }
  EXPECT_EQ(files[in_file], files[in_memory]);
  EXPECT_EQ(files[resumed], files[in_memory]);
}

TEST(GaussianTraining, SurvivesPhotographsThatShowNothing) {
  const Files files;
  Dataset dataset = disc_dataset();
  for (auto* views : {&dataset.train, &dataset.test})
    for (Photograph& view : *views) view.image = Image8(size, size, glm::u8vec4(255));
  // White on white: all splats fade.
  GaussianRequest asked =
      request(files, {{.steps = 120, .max_splats = 60, .first_splats = 50, .densify_every = 10}});
  Scene scene;
  asked.run.finished = [&](const Scene& finished) { scene = finished; };
  const SplatResult result = train_splats(dataset, std::move(asked));
  EXPECT_GT(result.run.test_psnr_db.value(), 20);
  EXPECT_EQ(defect(std::get<Splats>(only_layer(scene).primitives)).value_or(""), "");
}

}  // namespace gaussian_run_test
}  // namespace tureen::trainer
