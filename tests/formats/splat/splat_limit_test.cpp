// Reading a part of a file's splats: the same ones as of the whole scene, in every format.
#include "scene/edit/splat_limit.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <limits>

#include "base/memory_budget.hpp"
#include "formats/scene_file.hpp"
#include "formats/splat/splat_ply.hpp"
#include "scene/edit/morton_order.hpp"
#include "tests/formats/random_scene.hpp"
#include "tests/support/errors.hpp"

namespace tureen {
namespace splat_reading_limit_test {

class SplatReadingLimit : public ::testing::Test {
 protected:
  std::filesystem::path path(const char* name) const {
    // Tests run at the same time.
    const std::string test = ::testing::UnitTest::GetInstance()->current_test_info()->name();
    return std::filesystem::path(::testing::TempDir()) / (test + name);
  }
  void TearDown() override {
    set_max_memory(default_max_memory);
    for (const char* name : {".ply", ".glb", ".splat"}) std::filesystem::remove(path(name));
  }
};

void expect_limited(const std::filesystem::path& file) {
  const Scene whole = read_scene(file);
  std::uint64_t all = 0;
  for (const Layer& layer : whole.layers) all += count(std::get<Splats>(layer.primitives));
  for (const std::uint64_t max : {std::uint64_t(3), all / 2, all - 1, all, all + 1}) {
    SCOPED_TRACE(file.string() + ", " + std::to_string(max));
    std::uint64_t found = 0;
    ReadOptions options{.max_splats = max};
    options.found_splats = [&](std::uint64_t splats, std::uint64_t) { found = splats; };
    Scene read = read_scene(file, options), expected = whole;
    limit_splats(expected, max);
    // The curve depends on the box around the splats.
    for (Scene* scene : {&read, &expected})
      for (Layer& layer : scene->layers) sort_in_morton_order(std::get<Splats>(layer.primitives));
    EXPECT_EQ(test::difference(read, expected), "");
    EXPECT_EQ(found, all);
  }
}

TEST_F(SplatReadingLimit, KeepsTheLargestOfTheWholeScene) {
  test::RandomScene random(2);
  Scene scene = scene_of(random.gaussians(60, 2, "3dgs", false));
  write_scene(scene, path(".ply"));
  expect_limited(path(".ply"));
  scene.layers.push_back({.name = "second", .primitives = random.neural_densities(30, 1)});
  scene.layers.push_back({.name = "third", .primitives = random.gaussians(11, 3, "2dgs", true)});
  write_scene(scene, path(".glb"));
  expect_limited(path(".glb"));
  std::ofstream records(path(".splat"), std::ios::binary);
  for (int i = 0; i < 40; ++i) {
    float values[6];
    for (float& value : values) value = random.real(0.1f, 1.0f);
    records.write(reinterpret_cast<const char*>(values), sizeof values);
    for (int k = 0; k < 8; ++k) records.put(char(random.whole(256)));
  }
  records.close();
  expect_limited(path(".splat"));
}

TEST_F(SplatReadingLimit, IsSuggestedWhenTheMemoryIsTooSmall) {
  test::RandomScene random(3);
  for (const int degree : {0, 3}) {
    const Splats splats = random.gaussians(2000, degree, "3dgs", false);
    write_scene(scene_of(splats), path(".ply"));
    // Too little for the splats, and enough for the splats but not for their order.
    for (const double part : {0.3, 1.6}) {
      set_max_memory(std::uint64_t(part * double(byte_size(splats))));
      std::string hint;
      try {
        read_scene(path(".ply"));
      } catch (const InputError& error) {
        hint = error.hint();
      }
      const std::size_t at = hint.find("--max-splats ");
      ASSERT_NE(at, std::string::npos) << hint;
      const std::uint64_t fitting = std::stoull(hint.substr(at + 13));
      EXPECT_GT(fitting, 100u);
      EXPECT_NO_THROW(read_scene(path(".ply"), {.max_splats = fitting}));
    }
  }
}

/// Splats::rows: readers drop, limit and reorder.
TEST_F(SplatReadingLimit, RowsNameTheSplatsOfTheFile) {
  test::RandomScene random(4);
  Splats splats = random.gaussians(60, 1, "3dgs", false);
  splats.color.coefficients[4 * 10].x = std::numeric_limits<float>::infinity();
  write_splat_ply(scene_of(splats), path(".ply"));
  EXPECT_TRUE(std::get<Splats>(only_layer(read_scene(path(".ply"))).primitives).rows.empty());
  for (const std::uint64_t max : {20, 60}) {
    const Scene read = read_scene(path(".ply"), {.max_splats = max, .keep_rows = true});
    const auto& kept = std::get<Splats>(only_layer(read).primitives);
    ASSERT_EQ(kept.rows.size(), std::min<std::size_t>(max, 59));
    EXPECT_FALSE(std::is_sorted(kept.rows.begin(), kept.rows.end()));
    for (std::size_t i = 0; i < kept.rows.size(); ++i)
      EXPECT_EQ(center(kept, i), center(splats, kept.rows[i])) << i;
  }
}

}  // namespace splat_reading_limit_test
}  // namespace tureen
