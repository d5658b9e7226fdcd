// SOG: values byte by byte, streamed scenes, the writer with its codebooks and palettes, damage.
#include "formats/sog/sog.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>

#include "formats/common/format_remarks.hpp"
#include "formats/scene_file.hpp"
#include "formats/sog/codebook.hpp"
#include "formats/sog/palette.hpp"
#include "formats/sog/sog_remarks.hpp"
#include "tests/formats/format_testing.hpp"
#include "tests/formats/splat/sog_fixture.hpp"
#include "tests/formats/splat/splat_fixture.hpp"
#include "tests/formats/truncation.hpp"
#include "tests/support/random_splats.hpp"

namespace tureen {
namespace sog_test {

using namespace test;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

void write_files(const std::filesystem::path& folder, const test::SogFiles& files) {
  for (const auto& [name, content] : files) {
    std::filesystem::create_directories((folder / name).parent_path());
    std::ofstream(folder / name, std::ios::binary) << content;
  }
}

Scene read_zip(const std::string& bytes, const ReadOptions& options = {},
               MemoryBudget budget = MemoryBudget()) {
  return read_sog_archive(Input::memory("a.sog", as_bytes(bytes), std::move(budget)), options);
}

std::size_t count_at(const std::filesystem::path& path, std::size_t lod) {
  return count(only_splats(read_scene(path, {.lod = lod})));
}

/// The place of the splat with this x, to the nearest.
std::size_t splat_at(const Gaussians& gaussians, float x) {
  const auto found = std::min_element(
      gaussians.centers.begin(), gaussians.centers.end(),
      [&](const auto& a, const auto& b) { return std::abs(a.x - x) < std::abs(b.x - x); });
  return std::size_t(found - gaussians.centers.begin());
}

class Sog : public ::testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Version, Sog, ::testing::Values(1, 2));

TEST_P(Sog, HasKnownValuesInAFolderAndInAnArchive) {
  const test::SogFiles files = two_splats(GetParam());
  const TemporaryFolder folder;
  write_files(folder / "robot", files);
  for (const Scene& scene : {read_scene(folder / "robot"), read_scene(folder / "robot/meta.json"),
                             read_zip(zipped(files))}) {
    const Gaussians& g = only_gaussians(scene);
    ASSERT_EQ(g.centers.size(), 2u);
    const std::size_t first = splat_at(g, 1.7f), second = 1 - first;
    const double e = std::exp(1.0);
    // 1e-6: rounding to float. 2e-5: half of the 65,535 steps of -1..1, at a slope of 1.
    EXPECT_NEAR(g.centers[first].x, e - 1, 1e-6);
    EXPECT_NEAR(g.centers[first].y, 0, 2e-5);
    EXPECT_NEAR(g.centers[second].z, 1 - e, 1e-6);
    EXPECT_NEAR(g.scales[first].x, std::exp(-4.0), 1e-6);
    EXPECT_NEAR(g.scales[first].y, std::exp(-3.0), 1e-6);
    EXPECT_NEAR(g.scales[second].x, std::exp(255 / 64.0 - 4), 1e-6);
    // (w, x, y, z): w is the largest of the first, y of the second, whose w is -sqrt(1/2).
    EXPECT_NEAR(std::abs(g.rotations[first].w), 1, 1e-4);
    EXPECT_NEAR(std::abs(g.rotations[second].w), std::sqrt(0.5), 1e-4);
    EXPECT_NEAR(g.rotations[second].w * g.rotations[second].y, -0.5, 1e-4);
    const SplatColor& color = only_splats(scene).color;
    ASSERT_EQ(color.degree, 1);
    EXPECT_LT(glm::length(color.coefficients[4 * first] - glm::vec3(-1, 0, 0.5f)), 1e-5f);
    // The second entry of the palette.
    EXPECT_LT(glm::length(color.coefficients[4 * first + 3] - glm::vec3(50, 51, 52) / 256.0f),
              1e-6f);
    EXPECT_LT(glm::length(color.coefficients[4 * second + 1] - glm::vec3(0, 1, 2) / 256.0f), 1e-6f);
    EXPECT_NEAR(g.opacity[first], GetParam() == 2 ? 1 : 1 / (1 + std::exp(-2.0)), 1e-6);
    EXPECT_EQ(only_splats(scene).profile, *profile_named("3dgs"));
    EXPECT_EQ(scene.info.up, glm::vec3(0, -1, 0));
  }
  EXPECT_EQ(read_scene(folder / "robot").info.name, "robot");
  EXPECT_EQ(read_scene(folder / "robot/meta.json").info.name, "robot");
}

TEST(Sog, EachFaultNamesFileAndReason) {
  const auto refusal_of = [](const std::string& name, const std::string& content) {
    test::SogFiles files = two_splats(2);
    for (auto& [file, bytes] : files)
      if (file == name) bytes = content;
    return error_of([&] { read_zip(zipped(files)); });
  };
  const std::string meta = two_splats(2)[0].second;
  const auto changed = [&](const std::string& from, const std::string& to) {
    std::string text = meta;
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return refusal_of("meta.json", text.replace(at, from.size(), to));
  };
  EXPECT_THAT(changed("\"version\":2", "\"version\":3"), ErrorIn("a.sog/meta.json", "1 and 2"));
  EXPECT_THAT(changed("\"count\":2,\"means", "\"count\":3,\"means"),
              ErrorIn("a.sog/means_l.webp", "cannot hold 3 splats"));
  EXPECT_THAT(changed("\"count\":2,\"means", "\"count\":4000000000,\"means"),
              ErrorIn("a.sog/meta.json", "cannot hold 4000000000 splats"));
  EXPECT_THAT(changed("quats.webp", "turns.webp"), ErrorIn("a.sog/turns.webp", "missing"));
  EXPECT_THAT(refusal_of("scales.webp", "RIFF"), ErrorIn("a.sog/scales.webp", ""));
  EXPECT_THAT(refusal_of("meta.json", "{"), ErrorIn("a.sog/meta.json", "JSON"));
  // A splat outside the palette costs this splat.
  test::SogFiles files = two_splats(2);
  files.back().second = two_pixels({77, 0, 0, 255}, {0, 0, 0, 255});
  const Scene scene = read_zip(zipped(files));
  EXPECT_EQ(only_gaussians(scene).centers.size(), 1u);
  EXPECT_EQ(scene.info.remarks.back(),
            (Remark{&remarks::splats_dropped, {{"dropped", 1}, {"all", 2}}}));
}

TEST(Sog, AStreamedSceneHasTheLevelThatIsAskedForOrFits) {
  const TemporaryFolder folder;
  write_files(folder / "scene", streamed_splats());
  const auto count_at = [&](const ReadOptions& options) {
    return count(only_splats(read_scene(folder / "scene", options)));
  };
  // Each level, and the environment's two.
  EXPECT_EQ(count_at({}), 6u);
  EXPECT_EQ(count_at({.lod = 0}), 6u);
  EXPECT_EQ(count_at({.lod = 1}), 4u);
  EXPECT_EQ(count_at({.max_splats = 5}), 4u);
  EXPECT_EQ(count_at({.max_splats = 3}), 3u);
  EXPECT_THAT(error_of([&] { count_at({.lod = 2}); }), ErrorIn("scene", "levels 0 to 1"));
  const Scene chosen = read_scene(folder / "scene/lod-meta.json", {.max_splats = 5});
  EXPECT_EQ(chosen.info.name, "scene");
  EXPECT_THAT(
      chosen.info.remarks,
      ::testing::Contains(Remark{&remarks::level_chosen,
                                 {{"levels", 2}, {"level", 1}, {"splats", 4}, {"finest", 4}}}));
  EXPECT_THAT(read_scene(folder / "scene", {.lod = 1}).info.remarks,
              ::testing::Contains(
                  Remark{&remarks::level_read, {{"levels", 2}, {"level", 1}, {"splats", 4}}}));
  // Memory decides, too: an archive of the same files.
  const std::string bytes = zipped(streamed_splats());
  std::size_t least = 6;
  for (std::uint64_t limit = 1 << 19; limit > 1 << 14; limit -= 1 << 12) try {
      least = std::min(least, count(only_splats(read_zip(bytes, {}, MemoryBudget(limit)))));
    } catch (const InputError& error) {
      EXPECT_TRUE(is_about_memory(error)) << error.what();
    }
  EXPECT_LE(least, 6u);
}

/// A caller that has only lod-meta.json, and gets the files that are named until none is missing.
TEST(Sog, NeedsExactlyTheFilesOfItsLevel) {
  const auto fetched = [](const ReadOptions& options) {
    const TemporaryFolder folder;
    const test::SogFiles files = streamed_splats();
    write_files(folder / "scene", {files.front()});
    std::size_t count = 1;
    for (;;) {
      const SogNeeds needs = sog_needs(folder / "scene/lod-meta.json", options);
      EXPECT_THAT(needs.levels, ElementsAre(4, 2));
      if (needs.missing.empty()) break;
      for (const std::string& name : needs.missing) {
        const auto found = std::find_if(files.begin(), files.end(),
                                        [&](const auto& file) { return file.first == name; });
        EXPECT_NE(found, files.end()) << name;
        if (found == files.end()) return std::pair(count, std::size_t(0));
        write_files(folder / "scene", {*found});
        ++count;
      }
    }
    const std::size_t level = sog_needs(folder / "scene/lod-meta.json", options).level;
    return std::pair(count, count_at(folder / "scene/lod-meta.json", level));
  };
  // meta.json and five images each: two parts or one, and the environment.
  EXPECT_EQ(fetched({}), std::pair(std::size_t(1 + 3 * 6), std::size_t(6)));
  EXPECT_EQ(fetched({.max_splats = 3}), std::pair(std::size_t(1 + 2 * 6), std::size_t(4)));
  EXPECT_EQ(fetched({.lod = 1}), std::pair(std::size_t(1 + 2 * 6), std::size_t(4)));

  const TemporaryFolder folder;
  test::SogFiles plain = two_splats(2);
  write_files(folder / "scene", {plain.front()});
  EXPECT_THAT(sog_needs(folder / "scene/meta.json").missing, testing::SizeIs(7));
  EXPECT_THAT(sog_needs(folder / "scene/meta.json").levels, testing::IsEmpty());
  // A name that leads out is not fetched: the reader rejects it.
  std::string& meta = plain.front().second;
  meta.insert(meta.find("quats.webp"), "../");
  write_files(folder / "scene", {plain.front()});
  EXPECT_THAT(sog_needs(folder / "scene/meta.json").missing, testing::SizeIs(6));
  meta.replace(meta.find("../"), 3, "a..");
  write_files(folder / "scene", {plain.front()});
  EXPECT_THAT(sog_needs(folder / "scene/meta.json").missing, testing::Contains("a..quats.webp"));
}

TEST(Sog, WrittenSplatsAreReadWithinTheRounding) {
  const TemporaryFolder folder;
  for (const char* profile : {"3dgs", "mip", "2dgs"})
    for (const int degree : {0, 2, 3}) {
      const SplatKind kind{
          "", profile,
          std::string(profile) == "2dgs" ? SplatKind::Kernel::flat : SplatKind::Kernel::gaussians};
      Splats splats = random_splats(kind, 300, 0.05, 7);  // degree 2
      if (degree == 0) {
        SplatColor plain;
        for (std::size_t i = 0; i < 300; ++i)
          plain.coefficients.push_back(splats.color.coefficients[9 * i]);
        splats.color = plain;
      } else if (degree == 3) {
        SplatColor more{.degree = 3};
        for (std::size_t i = 0; i < 300; ++i)
          for (std::size_t k = 0; k < 16; ++k)
            more.coefficients.push_back(splats.color.coefficients[9 * i + k % 9] * 0.1f);
        splats.color = more;
      }
      const Scene before = scene_of(splats);
      EXPECT_THAT(write_scene(before, folder / "a.sog"), ElementsAre(HasSubstr("up axis")));
      const Scene after = read_scene(folder / "a.sog");
      const Splats& found = only_splats(after);
      ASSERT_EQ(count(found), 300u) << profile;
      EXPECT_EQ(found.profile.low_pass, splats.profile.low_pass);
      ASSERT_EQ(found.color.degree, degree);
      const auto& expected = std::get<Gaussians>(splats.kernel);
      const auto& g = std::get<Gaussians>(found.kernel);
      EXPECT_EQ(g.flat, expected.flat);
      double squared = 0, all = 0;
      for (std::size_t i = 0; i < 300; ++i) {
        // Both are in Morton order only of their own centres: the nearest centre belongs to it.
        std::size_t j = 0;
        for (std::size_t k = 1; k < 300; ++k)
          if (glm::distance(g.centers[k], expected.centers[i]) <
              glm::distance(g.centers[j], expected.centers[i]))
            j = k;
        // Of 2 log(2) in 65,535 steps, at a slope of at most 2.
        EXPECT_LT(glm::distance(g.centers[j], expected.centers[i]), 5e-5f);
        EXPECT_NEAR(g.opacity[j], expected.opacity[i], 0.5 / 255 + 1e-6);
        const std::size_t each = coefficients_per_splat(found.color);
        for (std::size_t k = 0; k < each; ++k) {
          const glm::vec3 difference =
              found.color.coefficients[each * j + k] - splats.color.coefficients[each * i + k];
          if (k == 0) {
            // The codebook has 256 values for 900.
            EXPECT_LT(glm::length(difference), 0.05f);
            continue;
          }
          squared += double(glm::dot(difference, difference));
          all += double(glm::dot(splats.color.coefficients[each * i + k],
                                 splats.color.coefficients[each * i + k]));
        }
        // The covariance, which has no order of axes: parts of quaternions have steps of 0.0055,
        // scales of about 0.03 relative.
        const auto covariance = [](const Gaussians& from, std::size_t at) {
          glm::vec3 scales = from.scales[at];
          if (from.flat) scales.z = 0;
          const glm::mat3 axes = glm::mat3_cast(from.rotations[at]);
          const glm::mat3 half(axes[0] * scales.x, axes[1] * scales.y, axes[2] * scales.z);
          return half * glm::transpose(half);
        };
        const glm::mat3 a = covariance(g, j), b = covariance(expected, i);
        float difference = 0, size = 0;
        for (int c = 0; c < 3; ++c) {
          difference += glm::dot(a[c] - b[c], a[c] - b[c]);
          size += glm::dot(b[c], b[c]);
        }
        EXPECT_LT(std::sqrt(difference), 0.04f * std::sqrt(size)) << profile << " " << i;
      }
      // 300 splats have a palette of 256 entries, so at least 44 share one: at most 88 / 300 of the
      // energy would be lost if these had nothing in common.
      EXPECT_LE(squared, 0.3 * all) << profile << " " << degree;
    }
}

TEST(Sog, AnArchiveSurvivesDamage) {
  const TemporaryFolder folder;
  const SplatKind kind{"", "3dgs", SplatKind::Kernel::gaussians};
  write_scene(scene_of(random_splats(kind, 3, 0.1, 7)), folder / "a.sog");
  std::vector<std::byte> bytes = Input::open(folder / "a.sog").read_rest();
  const auto read = [](std::span<const std::byte> damaged) {
    const Scene scene = read_sog_archive(Input::memory("a.sog", damaged));
    EXPECT_EQ(defect(only_splats(scene)), std::nullopt);
  };
  EXPECT_EQ(survive_truncation(bytes, read).read, 0u);
  EXPECT_GT(survive_damage(bytes, read, Damage::one).refused, 100u);
}

/// Cuts and damages this file of the scene at every byte.
void expect_file_survives(test::SogFiles files, const std::string& name) {
  const auto file = std::find_if(files.begin(), files.end(),
                                 [&](const auto& each) { return each.first == name; });
  ASSERT_NE(file, files.end()) << name;
  const std::string original = file->second;
  const auto read = [&](std::span<const std::byte> damaged) {
    file->second.assign(reinterpret_cast<const char*>(damaged.data()), damaged.size());
    EXPECT_EQ(defect(only_splats(read_zip(zipped(files)))), std::nullopt);
  };
  EXPECT_NO_THROW(read(as_bytes(original)));
  EXPECT_EQ(survive_truncation(as_bytes(original), read).read, 0u) << name;
  EXPECT_GT(survive_damage(as_bytes(original), read).refused, 100u) << name;
}

TEST(Sog, MetaOfVersion1SurvivesDamageAtEveryByte) {
  expect_file_survives(two_splats(1), "meta.json");
}

TEST(Sog, SmallFilesOfAStreamedSceneSurviveDamageAtEveryByte) {
  // Version 1 has no codebooks, which would be most of the bytes.
  for (const char* name : {"lod-meta.json", "0_1/meta.json", "env/meta.json", "env/means_u.webp"})
    expect_file_survives(streamed_splats(1), name);
}

TEST(Codebook, KeepsFewValuesAndIsNearTheOptimumForMany) {
  std::vector<float> few;
  for (int i = 0; i < 1000; ++i) few.push_back(float(i % 250) * 0.37f);
  const Codebook kept = best_codebook(few);
  for (const float value : few) EXPECT_EQ(kept[nearest_in(kept, value)], value);

  // Equal density: the optimum has equal steps d, and the mean squared error d^2 / 12.
  std::mt19937 random(5);
  std::vector<float> uniform(200000);
  for (float& value : uniform) value = float(random() % 1000000) * 1e-6f;
  uniform[3] = 900;  // an outlier takes one code
  const Codebook book = best_codebook(uniform);
  EXPECT_TRUE(std::is_sorted(book.begin(), book.end()));
  double squared = 0;
  for (const float value : uniform)
    squared += std::pow(double(book[nearest_in(book, value)]) - double(value), 2);
  EXPECT_LT(squared / double(uniform.size()), 1.03 * std::pow(1.0 / 255, 2) / 12);
}

/// The squared error of Lloyd's k-means in 20 steps, from rows at equal distances.
double plain_k_means_error(std::span<const float> vectors, std::size_t dimensions,
                           std::size_t size) {
  const std::size_t rows = vectors.size() / dimensions;
  std::vector<double> entries(size * dimensions);
  for (std::size_t k = 0; k < size; ++k)
    for (std::size_t d = 0; d < dimensions; ++d)
      entries[k * dimensions + d] = double(vectors[k * rows / size * dimensions + d]);
  double error = 0;
  for (int step = 0; step < 20; ++step) {
    std::vector<double> sums(entries.size(), 0.0), counts(size, 0.0);
    error = 0;
    for (std::size_t i = 0; i < rows; ++i) {
      double least = 1e30;
      std::size_t nearest = 0;
      for (std::size_t k = 0; k < size; ++k) {
        double squared = 0;
        for (std::size_t d = 0; d < dimensions; ++d)
          squared += std::pow(entries[k * dimensions + d] - double(vectors[i * dimensions + d]), 2);
        if (squared < least) {
          least = squared;
          nearest = k;
        }
      }
      error += least;
      ++counts[nearest];
      for (std::size_t d = 0; d < dimensions; ++d)
        sums[nearest * dimensions + d] += double(vectors[i * dimensions + d]);
    }
    for (std::size_t k = 0; k < size; ++k)
      for (std::size_t d = 0; d < dimensions && counts[k] > 0; ++d)
        entries[k * dimensions + d] = sums[k * dimensions + d] / counts[k];
  }
  return error;
}

TEST(Palette, IsNearPlainKMeansAndKeepsFewRows) {
  // Rows in 300 clusters; 512 entries, in two cells.
  std::mt19937 random(9);
  std::normal_distribution<float> normal;
  const std::size_t dimensions = 9, rows = 6000;
  std::vector<float> centers(300 * dimensions), vectors(rows * dimensions), weights(rows, 1.0f);
  for (float& value : centers) value = normal(random);
  for (std::size_t i = 0; i < rows; ++i)
    for (std::size_t d = 0; d < dimensions; ++d)
      vectors[i * dimensions + d] = centers[i % 300 * dimensions + d] + 0.05f * normal(random);
  Palette palette(vectors, dimensions, weights, 512);
  ASSERT_EQ(palette.count(), 512u);
  double squared = 0;
  for (std::size_t i = 0; i < rows; ++i)
    for (std::size_t d = 0; d < dimensions; ++d)
      squared += std::pow(double(palette.entries()[palette.indices()[i] * dimensions + d]) -
                              double(vectors[i * dimensions + d]),
                          2);
  EXPECT_LT(squared, 1.1 * plain_k_means_error(vectors, dimensions, 512));

  const auto small = std::span(vectors).first(100 * dimensions);
  const Palette exact(small, dimensions, weights, 128);
  EXPECT_TRUE(
      std::equal(small.begin(), small.end(), exact.entries().begin(), exact.entries().end()));
}

TEST(Sog, ARealStreamedSceneIsRead) {
  const std::filesystem::path scene =
      std::filesystem::path(TUREEN_SOURCE_DIR) / "../shared/data/gaussians/playbot";
  if (!std::filesystem::exists(scene)) GTEST_SKIP() << "no " << scene;
  const Scene coarse = read_scene(scene, {.lod = 3});
  EXPECT_EQ(count(only_splats(coarse)), 31000u);
  EXPECT_EQ(only_splats(coarse).color.degree, 2);
  const Scene limited = read_scene(scene, {.max_splats = 130000});
  EXPECT_EQ(count(only_splats(limited)), 125000u);
  // The tree's box, with the extents of the splats, holds all centres.
  const Bounds box = bounds(limited.layers[0]);
  EXPECT_LT(glm::length(box.high - glm::vec3(1.035, 0.052, 1.042)), 0.3f);
}

}  // namespace sog_test
}  // namespace tureen
