// Hostile and damaged files: every reader returns a scene or throws an error with file and reason,
// within bounds on memory and time.
//
// Damage starts from the fixtures of the fuzzers (tests/fuzz/fixtures.cpp). False sizes are in
// hostile_sizes_test.cpp, faults that only JSON can have in hostile_json_test.cpp, and files by
// others in hostile_files_test.cpp.
#include <gmock/gmock.h>
#include <sys/inotify.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdlib>
#include <cstring>
#include <nlohmann/json.hpp>

#include "formats/dataset/camera_file.hpp"
#include "formats/dataset/colmap.hpp"
#include "formats/dataset/dataset.hpp"
#include "formats/scene_file.hpp"
#include "formats/splat/spz.hpp"
#include "formats/torch/checkpoint.hpp"
#include "image/png.hpp"
#include "tests/formats/dataset/dataset_fixture.hpp"
#include "tests/formats/format_testing.hpp"
#include "tests/formats/hostile_bounds.hpp"
#include "tests/formats/splat/spz_fixture.hpp"
#include "tests/formats/torch_fixture.hpp"
#include "tests/formats/truncation.hpp"
#include "tests/fuzz/fixtures.hpp"
#include "tests/fuzz/folder_files.hpp"
#include "tests/fuzz/targets.hpp"
#include "tests/support/measured.hpp"
#include "tests/support/random.hpp"

namespace tureen {
namespace hostile_test {

using test::ErrorAt;
using test::ErrorIn;
using test::Names;
namespace fs = std::filesystem;
using test::Bytes;
using test::bytes_of;
using test::Cost;
using test::error_of;
using test::MemoryMeter;
using test::TemporaryFolder;
using test::uncounted;
using test::within_bounds;

// ---- Damage

/// Number of damaged copies of each fixture, default 500. Each file of a folder is a fixture, and
/// GLB has fifteen. TUREEN_FLIPS sets another number: `./dev faults` sets 10,000.
int flips() {
  const char* asked = std::getenv("TUREEN_FLIPS");
  if (!asked) return 500;
  int number = 0;
  const auto [end, error] = std::from_chars(asked, asked + std::strlen(asked), number);
  if (error != std::errc() || *end != '\0' || number < 1)
    ADD_FAILURE() << "TUREEN_FLIPS must be a positive integer: " << asked;
  return number;
}

class Hostile : public ::testing::TestWithParam<fuzz::Target> {};

TEST_P(Hostile, DamageEndsInAnErrorOrAScene) {
  const fuzz::Target& target = GetParam();
  constexpr std::uint64_t limit = 8 << 20;
  std::size_t fixtures = 0;
  Cost most;
  test::Survival cut, flipped;
  for (const fuzz::Fixture& fixture : fuzz::fixtures()) {
    if (fixture.target != target.name) continue;
    ++fixtures;
    SCOPED_TRACE(fixture.name);
    ASSERT_NO_THROW(target.read(fixture.bytes));
    const auto read = [&](std::span<const std::byte> bytes) {
      const Cost cost = within_bounds(
          limit, [&] { target.read(bytes); }, "one of the reads");
      most = {std::max(most.bytes, cost.bytes), std::max(most.seconds, cost.seconds)};
    };
    const std::size_t cut_before = cut.read + cut.refused;
    test::survive_truncation(fixture.bytes, read, cut);
    EXPECT_EQ(cut.read + cut.refused - cut_before, fixture.bytes.size());

    const unsigned seed = 1;
    test::Random random(seed);
    const std::size_t flipped_before = flipped.read + flipped.refused;
    for (int i = 0; i < flips(); ++i) {
      Bytes bytes = fixture.bytes;
      // Usually one bit, sometimes several bits and whole bytes.
      for (int damage = 1 + int(random.below(4)) / 3 * int(random.below(6)); damage > 0; --damage) {
        std::byte& victim = bytes[random.below(bytes.size())];
        victim = random.chance(0.7) ? victim ^ static_cast<std::byte>(1u << random.below(8))
                                    : static_cast<std::byte>(random.below(256));
      }
      test::expect_survival(bytes, read,
                            "seed " + std::to_string(seed) + ", flips number " + std::to_string(i),
                            flipped);
      if (HasFailure()) return;
    }
    EXPECT_EQ(flipped.read + flipped.refused - flipped_before, std::size_t(flips()));
  }
  EXPECT_GT(fixtures, 0u) << "no fixture for this target";
  test::leave_measured("readers", {{"reader", target.name},
                                   {"fixtures", fixtures},
                                   {"cut_read", cut.read},
                                   {"cut_refused", cut.refused},
                                   {"flipped_read", flipped.read},
                                   {"flipped_refused", flipped.refused},
                                   {"memory_kb", 1e-3 * double(most.bytes)},
                                   {"slowest_ms", 1e3 * most.seconds}});
}

INSTANTIATE_TEST_SUITE_P(Targets, Hostile, ::testing::ValuesIn(fuzz::targets),
                         [](const auto& target) { return target.param.name; });

TEST(HostileCrashes, FoundByFuzzersEndInAnErrorOrAScene) {
  std::size_t files = 0;
  for (const fuzz::Target& target : fuzz::targets) {
    const fs::path folder = fs::path(TUREEN_SOURCE_DIR) / "tests/fuzz/crashes" / target.name;
    if (!fs::exists(folder)) continue;
    for (const auto& entry : fs::directory_iterator(folder)) {
      ++files;
      const Bytes bytes = Input::open(entry.path()).read_rest();
      test::Survival survival;
      within_bounds(
          32 << 20,
          [&] { test::expect_survival(bytes, target.read, entry.path().string(), survival); },
          entry.path().string());
    }
  }
  EXPECT_GT(files, 0u);
}

// ---- Decompression bombs

TEST(HostileBombs, AnImageThatUnfoldsBeyondItsPixels) {
  // One pixel, followed by 64 MB of zeros, which take a few kilobytes in the file.
  const Bytes bomb = fuzz::PngFixture{.rows = std::string(64 << 20, '\0')}.bytes();
  EXPECT_LT(bomb.size(), 100u << 10);
  within_bounds(
      default_max_memory,
      [&] {
        const MemoryMeter meter;
        EXPECT_THAT(error_of([&] { decode_image(bomb, "bomb.png"); }), ErrorAt("bomb.png"));
        EXPECT_LT(meter.peak(), uncounted);
      },
      "bomb");
}

TEST(HostileBombs, AnImageOfMorePixelsThanMemory) {
  // 6,000 x 6,000 black pixels: 144 MB, which take some kB in the file.
  const Bytes large =
      fuzz::PngFixture{
          .width = 6000, .height = 6000, .color_type = 0, .rows = std::string(6001u * 6000u, '\0')}
          .bytes();
  EXPECT_LT(large.size(), 1u << 20);
  within_bounds(
      128 << 20,
      [&] {
        EXPECT_THAT(error_of([&] { decode_image(large, "large.png"); }),
                    ErrorIn("large.png", 6000, 128));
      },
      "large");
  const Bytes beyond =
      fuzz::PngFixture{.width = 20000, .height = 20000, .color_type = 0, .rows = "x"}.bytes();
  EXPECT_THAT(error_of([&] { decode_image(beyond, "beyond.png"); }),
              ErrorIn("beyond.png", 20000, 65536, 268435456));
  // This size is above the limit of stb itself.
  const Bytes farther =
      fuzz::PngFixture{.width = 30000, .height = 30000, .color_type = 2, .rows = "x"}.bytes();
  EXPECT_THAT(error_of([&] { decode_image(farther, "farther.png"); }),
              ErrorIn("farther.png", 30000));
  const Bytes longer =
      fuzz::PngFixture{.width = 20000000, .height = 1, .color_type = 2, .rows = "x"}.bytes();
  EXPECT_THAT(error_of([&] { decode_image(longer, "longer.png"); }),
              ErrorIn("longer.png", 20000000, 1));
}

TEST(HostileBombs, ManyImagesInOneScene) {
  // One of these images fits into the limit, but a hundred do not.
  const Bytes image =
      fuzz::PngFixture{
          .width = 1000, .height = 1000, .color_type = 0, .rows = std::string(1001u * 1000u, '\0')}
          .bytes();
  const TemporaryFolder folder;
  test::write_bytes(folder / "a.png", image);
  nlohmann::json gltf = nlohmann::json::parse(R"({"asset": {"version": "2.0"},
    "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
    "accessors": [{"componentType": 5126, "count": 3, "type": "VEC3"},
                  {"componentType": 5126, "count": 3, "type": "VEC2"}]})");
  for (int i = 0; i < 100; ++i) {
    gltf["images"].push_back({{"uri", "a.png"}});
    gltf["textures"].push_back({{"source", i}});
    gltf["materials"].push_back({{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", i}}}}}});
    gltf["meshes"][0]["primitives"].push_back(
        {{"attributes", {{"POSITION", 0}, {"TEXCOORD_0", 1}}}, {"material", i}});
  }
  test::write_text(folder / "a.gltf", gltf.dump());
  within_bounds(
      64 << 20,
      [&] {
        EXPECT_THAT(error_of([&] { read_scene(folder / "a.gltf"); }),
                    ErrorIn("a.gltf", "images[", "--max-memory"));
      },
      "a hundred");
}

// Row X4 of the catalogue of numerical hazards; its pickles are in pickle_test.cpp.
TEST(HostileBombs, X4_AnArchiveThatInflatesBeyondItsSizes) {
  const std::string zeros(32 << 20, '\0');
  const std::string packed = test::ZipFixture::deflated(zeros);
  EXPECT_LT(packed.size(), 1u << 20);
  // The archive states the true size, a smaller one, and one above the maximal ratio of deflate.
  const std::pair<std::uint64_t, test::NamesMatcher> claims[] = {
      {zeros.size(), Names("a/data.pkl", 33554432, 16777216)},
      {1000, Names(2)},
      {0x7fffffff, Names("a/data.pkl")}};
  for (const auto& [claimed, says] : claims) {
    test::ZipFixture zip;
    zip.entries.push_back({"a/data.pkl", zeros, true});
    std::string bytes = zip.bytes();
    const auto size = std::uint32_t(claimed);
    const std::size_t directory = bytes.rfind(std::string("PK\1\2"));
    std::memcpy(&bytes[directory + 24], &size, sizeof size);
    within_bounds(
        8 << 20,
        [&, says = says] {
          EXPECT_THAT(error_of([&] {
                        read_checkpoint(Input::memory("bomb.pt", std::as_bytes(std::span(bytes))));
                      }),
                      says);
        },
        "an archive");
  }
}

TEST(HostileBombs, X4_SpzFilesThatUnpackBeyondMemory) {
  for (const unsigned version : {3u, 4u}) {
    // In version 4 the trailing bytes make the file large enough for the number of splats.
    test::SpzFixture spz{.version = version, .splats = 1000000, .trailing = std::string(9000, 'x')};
    const std::size_t strides[] = {9, 1, 3, 3, 4};
    for (std::size_t a = 0; a < 5; ++a) spz.arrays[a].assign(strides[a] * spz.splats, '\0');
    const std::string bytes = spz.bytes();
    EXPECT_LT(bytes.size(), 50u << 10);
    within_bounds(
        8 << 20,
        [&] {
          Input input = Input::memory("bomb.spz", std::as_bytes(std::span(bytes)));
          EXPECT_THAT(error_of([&] { read_spz(input); }), ErrorIn("bomb.spz", "--max-memory"));
        },
        "an SPZ file");
  }
}

TEST(HostileBombs, X4_PicklesThatDoubleThemselves) {
  // Each list contains the previous list twice, forty times: a walk over it would visit 2^40
  // elements.
  test::PickleFixture pickle;
  pickle.op("]q").op(std::string(1, '\0'));
  for (int i = 1; i < 40; ++i) {
    pickle.op("](h").op(std::string(1, char(i - 1))).op("h").op(std::string(1, char(i - 1)));
    pickle.op("eq").op(std::string(1, char(i)));
  }
  // All lists are on the stack: the reader rejects the pickle for that, or reads it without a walk.
  within_bounds(
      1 << 20, [&] { error_of([&] { fuzz::pickle(bytes_of(pickle.done())); }); }, "billion laughs");
}

// ---- Names

/// Detects whether a file was opened, while it exists.
class Tripwire {
 public:
  explicit Tripwire(const fs::path& file) : queue_(inotify_init1(IN_NONBLOCK)) {
    EXPECT_GE(queue_, 0);
    EXPECT_GE(inotify_add_watch(queue_, file.c_str(), IN_OPEN | IN_ACCESS), 0);
  }
  Tripwire(const Tripwire&) = delete;
  Tripwire& operator=(const Tripwire&) = delete;
  ~Tripwire() { close(queue_); }

  bool was_opened() const {
    char events[4096];
    return read(queue_, events, sizeof events) > 0;
  }

 private:
  int queue_;
};

TEST(Tripwire, TellsOfAFileThatIsOpened) {
  const TemporaryFolder folder;
  test::write_text(folder / "a", "text");
  const Tripwire wire(folder / "a");
  EXPECT_FALSE(wire.was_opened());
  Input::open(folder / "a").read_rest();
  EXPECT_TRUE(wire.was_opened());
}

std::string gltf_with_uri(const std::string& list, const std::string& uri) {
  auto json = nlohmann::json::parse(R"({"asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}],
    "nodes": [{"mesh": 0}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "material": 0}]}],
    "materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}],
    "textures": [{"source": 0}], "images": [{"uri": "inside.png"}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"},
                  {"componentType": 5126, "count": 3, "type": "VEC2"}],
    "bufferViews": [{"buffer": 0, "byteLength": 36}],
    "buffers": [{"byteLength": 36, "uri": "inside.bin"}]})");
  json[list][0]["uri"] = uri;
  return json.dump();
}

class HostileNames : public ::testing::Test {
 protected:
  void SetUp() override {
    test::write_image(folder / "outside.png", test::an_image(8, 6));
    test::write_bytes(folder / "outside.bin", Bytes(36));
    test::write_image(folder / "scene/inside.png", test::an_image(8, 6));
    test::write_bytes(folder / "scene/inside.bin", Bytes(36));
    fs::create_symlink(folder / "outside.png", folder / "scene/link.png");
    fs::create_symlink(folder / "outside.bin", folder / "scene/link.bin");
    fs::create_symlink(folder / "", folder / "scene/up");
  }
  TemporaryFolder folder;
};

TEST_F(HostileNames, OfAGltfDoNotLeadOutOfItsFolder) {
  const Tripwire image(folder / "outside.png"), bytes(folder / "outside.bin");
  test::write_text(folder / "scene/a.gltf", gltf_with_uri("images", "inside.png"));
  EXPECT_EQ(error_of([&] { read_scene(folder / "scene/a.gltf"); }), std::nullopt);
  for (const auto& [list, extension] : {std::pair("images", ".png"), std::pair("buffers", ".bin")})
    for (const std::string& name :
         {std::string("../outside"), std::string("x/../../outside"), std::string("%2e%2e/outside"),
          std::string("..\\outside"), (folder / "outside").string(),
          "file://" + (folder / "outside").string(), std::string("link"), std::string("up/outside"),
          std::string("up/scene/../outside")}) {
      test::write_text(folder / "scene/a.gltf", gltf_with_uri(list, name + extension));
      EXPECT_THAT(error_of([&] { read_scene(folder / "scene/a.gltf"); }), ErrorIn("a.gltf", list))
          << name;
    }
  EXPECT_FALSE(image.was_opened());
  EXPECT_FALSE(bytes.was_opened());
}

TEST_F(HostileNames, OfAFolderOfFixedNamesDoNotLeadOutOfIt) {
  const auto lead_out = [&](const fuzz::FolderFiles& files) {
    for (const auto& [name, content] : files) {
      fs::remove_all(folder / "fixed");
      for (const auto& [file, bytes] : files) test::write_bytes(folder / ("fixed/" + file), bytes);
      EXPECT_EQ(error_of([&] { read_scene(folder / "fixed"); }), std::nullopt);
      test::write_bytes(folder / "elsewhere", content);
      fs::remove(folder / ("fixed/" + name));
      fs::create_symlink("../elsewhere", folder / ("fixed/" + name));
      const Tripwire wire(folder / "elsewhere");
      EXPECT_THAT(error_of([&] { read_scene(folder / "fixed"); }), ErrorAt("fixed/" + name, name))
          << name;
      EXPECT_FALSE(wire.was_opened()) << name;
      // The reader follows a link within the folder.
      test::write_bytes(folder / "fixed/other", content);
      fs::remove(folder / ("fixed/" + name));
      fs::create_symlink("other", folder / ("fixed/" + name));
      EXPECT_EQ(error_of([&] { read_scene(folder / "fixed"); }), std::nullopt) << name;
    }
  };
  lead_out(fuzz::diffsoup_files());
  lead_out(fuzz::mobilenerf_files());
}

// Links, ".." and absolute names of photographs are followed: users store photographs apart from
// cameras. A URL is no name.
TEST_F(HostileNames, OfPhotographsAreNotUrls) {
  const Tripwire image(folder / "outside.png");
  const std::string outside = (folder / "outside.png").string();
  for (const std::string& name : {"file://" + outside, "\\\\" + outside}) {
    const std::string escaped = (name[0] == '\\' ? "\\\\" : "") + name;
    const std::string frame = R"({"file_path": ")" + escaped + R"(",
      "transform_matrix": [[1,0,0,0],[0,1,0,0],[0,0,1,2],[0,0,0,1]]})";
    test::write_text(folder / "scene/transforms.json",
                     R"({"camera_angle_x": 0.7, "frames": [)" + frame + "," + frame + "]}");
    EXPECT_THAT(error_of([&] { read_dataset(folder / "scene"); }), Names(outside)) << name;
    fs::remove(folder / "scene/transforms.json");
    test::ColmapFixture model = test::upright_colmap(2);
    for (auto& each : model.images) each.name = name;
    test::write_text(folder / "scene/sparse/0", model);
    fs::create_directories(folder / "scene/images");
    EXPECT_THAT(error_of([&] { read_dataset(folder / "scene"); }), Names(outside)) << name;
    fs::remove_all(folder / "scene/sparse");
  }
  EXPECT_FALSE(image.was_opened());
}

TEST_F(HostileNames, ThatAreNotUtf8EndInAnErrorOrAreReadAsTheyAre) {
  const std::string odd = "\xff\xfe\xc3(.off";
  test::write_text(folder / odd, "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
  EXPECT_EQ(only_soup(read_scene(folder / odd)).triangles.size(), 1u);
  test::write_text(folder / odd, "OFF\n3 1 0\n");
  EXPECT_THAT(error_of([&] { read_scene(folder / odd); }), ErrorIn(odd));
  // Such names are not valid in JSON.
  test::write_text(folder / "scene/a.gltf",
                   "{\"asset\": {\"version\": \"2.0\"}, \"images\": [{\"uri\": \"\xff.png\"}]}");
  EXPECT_THAT(error_of([&] { read_scene(folder / "scene/a.gltf"); }), ErrorIn("a.gltf"));
  // Names in COLMAP are bytes.
  test::ColmapFixture model = test::upright_colmap(2);
  model.images[0].name = "\xff\xfe.png";
  test::write_binary(folder / "scene/sparse/0", model);
  for (const std::string& name : {model.images[0].name, model.images[1].name})
    test::write_image(folder / ("scene/images/" + name), test::an_image(8, 6));
  const Dataset dataset = read_dataset(folder / "scene");
  EXPECT_EQ(dataset.test.size() + dataset.train.size(), 2u);
  cameras_to_json(std::array{dataset.train[0].camera, dataset.test[0].camera});
  // The message contains only a part of a name of 5000 letters.
  test::write_text(folder / "long.ply", "ply\nformat ascii 1.0\nelement " +
                                            std::string(5000, '\xff') + " 1 1\nend_header\n");
  EXPECT_LT(error_of([&] { read_scene(folder / "long.ply"); })->reason.size(), 1000u);
}

}  // namespace hostile_test
}  // namespace tureen
