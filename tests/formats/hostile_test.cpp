// Files that mean harm, or have met with some: every reader ends with a scene or with an error that
// names file and reason, within bounds of memory and time, and writes nothing.
//
// Past 600 lines: every kind of harm is done to every reader, by one set of helpers. What damage
// begins with are the fixtures that fuzzers begin with (tests/fuzz/fixtures.cpp).
#include <gmock/gmock.h>
#include <sys/inotify.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "formats/camera_file.hpp"
#include "formats/checkpoint.hpp"
#include "formats/colmap.hpp"
#include "formats/dataset.hpp"
#include "formats/dataset_fixture.hpp"
#include "formats/format_testing.hpp"
#include "formats/gltf.hpp"
#include "formats/json_file.hpp"
#include "formats/json_view.hpp"
#include "formats/memory_limit.hpp"
#include "formats/memory_meter.hpp"
#include "formats/off.hpp"
#include "formats/pickle.hpp"
#include "formats/ply.hpp"
#include "formats/png.hpp"
#include "formats/scene_file.hpp"
#include "formats/torch_fixture.hpp"
#include "formats/truncation.hpp"
#include "formats/tureen_glb_kinds.hpp"
#include "formats/zip_archive.hpp"
#include "fuzz/fixtures.hpp"
#include "fuzz/folder_files.hpp"
#include "fuzz/targets.hpp"
#include "support/measured.hpp"
#include "support/random.hpp"

namespace tureen {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::AnyOf;
using ::testing::HasSubstr;
using testing::input_error;
using testing::MemoryLimit;
using testing::MemoryMeter;
using testing::TemporaryFolder;
using Bytes = std::vector<std::byte>;

/// What readers have beside what they count: windows on texts (256 kB), blocks, a PLY header (1 MB)
/// in pieces, the tables of coders, errors and what GoogleTest keeps of them.
constexpr std::size_t uncounted = 4 << 20;

/// Longer than any read of a few kilobytes takes, even on a busy machine and with sanitizers; a
/// read whose time grows with a number in the file takes minutes.
constexpr double longest_read = 20;

/// What reads took at most.
struct Cost {
  std::size_t bytes = 0;  // of `new`
  double seconds = 0;
};

/// Calls `read` with no more memory than `limit`, and holds it to that.
template <class Read>
Cost within_bounds(std::uint64_t limit, Read&& read, const std::string& what) {
  const MemoryLimit scoped(limit);
  const MemoryMeter meter;
  const auto start = std::chrono::steady_clock::now();
  read();
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  const Cost cost{meter.peak(), seconds.count()};
  EXPECT_LT(cost.bytes, limit + uncounted) << what;
  EXPECT_LT(cost.seconds, longest_read) << what;
  return cost;
}

std::string text_of(const Bytes& bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

Bytes bytes_of(const std::string& text) {
  const auto bytes = std::as_bytes(std::span(text));
  return {bytes.begin(), bytes.end()};
}

// ---- Damage

/// Flips of each fixture: for a folder's formats each file is one, and of a GLB there are fifteen
/// kinds.
constexpr int flips = 10000;

class Hostile : public ::testing::TestWithParam<fuzz::Target> {};

TEST_P(Hostile, DamageEndsInAnErrorOrAScene) {
  const fuzz::Target& target = GetParam();
  constexpr std::uint64_t limit = 8 << 20;
  std::size_t fixtures = 0;
  Cost most;
  testing::Survival cut, flipped;
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
    testing::survive_truncation(fixture.bytes, read, cut);
    EXPECT_EQ(cut.read + cut.refused - cut_before, fixture.bytes.size());

    const unsigned seed = 1;
    test::Random random(seed);
    const std::size_t flipped_before = flipped.read + flipped.refused;
    for (int i = 0; i < flips; ++i) {
      Bytes bytes = fixture.bytes;
      // One bit most of the time; sometimes several, and whole bytes.
      for (int damage = 1 + int(random.below(4)) / 3 * int(random.below(6)); damage > 0; --damage) {
        std::byte& victim = bytes[random.below(bytes.size())];
        victim = random.chance(0.7) ? victim ^ static_cast<std::byte>(1u << random.below(8))
                                    : static_cast<std::byte>(random.below(256));
      }
      testing::expect_survival(
          bytes, read, "seed " + std::to_string(seed) + ", flips number " + std::to_string(i),
          flipped);
      if (HasFailure()) return;
    }
    EXPECT_EQ(flipped.read + flipped.refused - flipped_before, std::size_t(flips));
  }
  EXPECT_GT(fixtures, 0u) << "no fixture for this target";
  test::leave_measured("damage-" + std::string(target.name),
                       {{"reader", target.name},
                        {"fixtures", fixtures},
                        {"cut", {{"read", cut.read}, {"refused", cut.refused}}},
                        {"flipped", {{"read", flipped.read}, {"refused", flipped.refused}}},
                        {"bytes", most.bytes},
                        {"seconds", most.seconds}});
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
      testing::Survival survival;
      within_bounds(
          32 << 20,
          [&] { testing::expect_survival(bytes, target.read, entry.path().string(), survival); },
          entry.path().string());
    }
  }
  EXPECT_GT(files, 0u);
}

// ---- The files of others

/// The folder of hostile files beside the repository, where there is one.
fs::path hostile_files() { return TUREEN_SOURCE_DIR "/../shared/data/hostile"; }

std::map<fs::path, fs::file_time_type> listing(const fs::path& folder) {
  std::map<fs::path, fs::file_time_type> result;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    result[entry.path()] = entry.is_directory() ? fs::file_time_type() : entry.last_write_time();
  return result;
}

TEST(HostileFiles, OfOthersEndInAnErrorOrASceneAndNothingIsWritten) {
  const fs::path folder = hostile_files();
  if (!fs::exists(folder)) GTEST_SKIP() << "no " << folder;
  const auto before = listing(folder);
  std::size_t read = 0, refused = 0;
  for (const auto& [path, time] : before) {
    if (!fs::is_regular_file(path)) continue;
    const auto file = path;
    within_bounds(
        64 << 20,
        [&] {
          try {
            if (file.extension() == ".png") {
              Input input = Input::open(file);
              read_image(input);
            } else {
              read_scene(file);
            }
            ++read;
          } catch (const InputError& error) {
            ++refused;
            EXPECT_FALSE(error.reason().empty()) << file;
            EXPECT_THAT(error.place().file, HasSubstr(file.filename().string()));
          }
        },
        file.string());
  }
  EXPECT_EQ(listing(folder), before);
  // Some of them are valid: the reader says no to what is wrong and not to everything.
  EXPECT_GT(read, 50u);
  EXPECT_GT(refused, 50u);
}

// ---- Sizes that are false

/// Reading ends in an InputError that says this, having allocated next to nothing.
template <class Read>
void expect_refused(Read&& read, const std::string& what,
                    const ::testing::Matcher<std::string>& says) {
  std::string error;
  within_bounds(
      default_max_memory,
      [&] {
        const MemoryMeter meter;
        error = input_error(read);
        EXPECT_LT(meter.peak(), uncounted) << what;
      },
      what);
  EXPECT_THAT(error, says) << what;
}

constexpr std::array<std::uint64_t, 5> false_sizes{
    std::uint64_t(1) << 31, (std::uint64_t(1) << 32) - 1, std::uint64_t(1) << 32,
    std::uint64_t(1) << 63, ~std::uint64_t(0)};

TEST(HostileSizes, InTexts) {
  for (const std::uint64_t size : false_sizes) {
    const std::string n = std::to_string(size);
    for (const std::string& text : {"OFF\n" + n + " 1 0\n0 0 0\n", "OFF\n1 " + n + " 0\n0 0 0\n",
                                    "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n" + n + " 0 1 2\n"})
      expect_refused(
          [&] {
            Input input = testing::input_of(text, "a.off");
            read_off(input);
          },
          text, AnyOf(HasSubstr(n), HasSubstr("a.off:6: the line ends")));
    // Three of them, whatever the encoding.
    const std::string vertices = "0 0 0 \n0 0 0 \n0 0 0 \n0 0 0 \n0 0 0 \n0 0 0 \n";
    for (const char* encoding : {"ascii", "binary_little_endian", "binary_big_endian"})
      for (const std::string& elements :
           {"element vertex " + n +
                "\nproperty float x\nproperty float y\nproperty float z\nelement face 1\nproperty "
                "list uchar int vertex_indices\n",
            "element vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement "
            "face " +
                n + "\nproperty list uchar int vertex_indices\n",
            "element vertex 0\nproperty float x\nproperty float y\nproperty float z\nelement "
            "other " +
                n +
                "\nproperty double a\nelement face 1\nproperty list uchar int vertex_indices\n"}) {
        const std::string text = std::string("ply\nformat ") + encoding + " 1.0\n" + elements +
                                 "end_header\n" + vertices;
        expect_refused(
            [&] {
              Input input = testing::input_of(text, "a.ply");
              read_ply(input);
            },
            text, HasSubstr(n));
      }
    const std::string obj = "v 0 0 0\nvt 0 0\nf " + n + "/1 1/1 1/1\n";
    expect_refused([&] { fuzz::obj(bytes_of(obj)); }, obj, HasSubstr("fuzz.obj:3: "));
  }
}

TEST(HostileSizes, InBinaryFiles) {
  const auto put = [](Bytes& bytes, std::size_t at, auto value) {
    std::memcpy(&bytes.at(at), &value, sizeof value);
  };
  std::set<std::string> tried;
  for (const fuzz::Fixture& fixture : fuzz::fixtures()) {
    tried.insert(fixture.target == "colmap_binary" ? fixture.target : fixture.name);
    if (fixture.target == "colmap_binary") {
      // The count of records.
      for (const std::uint64_t size : false_sizes) {
        Bytes bytes = fixture.bytes;
        put(bytes, 1, size);
        expect_refused([&] { fuzz::colmap_binary(bytes); }, fixture.name,
                       HasSubstr("a count of " + std::to_string(size)));
      }
    } else if (fixture.name == "face_bytes.glb") {
      // The file's length and the JSON chunk's.
      for (const std::size_t at : {8, 12})
        for (const std::uint32_t size : {0x80000000u, 0xfffffffcu}) {
          Bytes bytes = fixture.bytes;
          put(bytes, at, size);
          expect_refused(
              [&] { fuzz::gltf(bytes); }, fixture.name,
              HasSubstr(std::to_string(size) + (at == 8 ? " bytes, it" : " bytes, but")));
        }
    } else if (fixture.name == "rgba.png") {
      for (const std::size_t at : {16, 20})
        for (const std::uint32_t size : {0x80u, 0xffffff7fu}) {  // big endian: 2^31, 2^31 - 1
          Bytes bytes = fixture.bytes;
          put(bytes, at, size);
          expect_refused([&] { fuzz::image(bytes); }, fixture.name, HasSubstr("fuzz.png: "));
        }
    } else if (fixture.name == "run.checkpoint") {
      for (const std::uint64_t size : false_sizes) {
        // Behind the magic and the version: the length of the configuration.
        Bytes bytes = fixture.bytes;
        const std::string text = text_of(bytes);
        const std::size_t at = text.find('{') - sizeof size;
        put(bytes, at, size);
        expect_refused([&] { fuzz::training_checkpoint(bytes); }, fixture.name,
                       HasSubstr("cut short: " + std::to_string(size) + " bytes expected"));
      }
    }
  }
  for (const char* name : {"colmap_binary", "face_bytes.glb", "rgba.png", "run.checkpoint"})
    EXPECT_TRUE(tried.contains(name)) << name;
}

TEST(HostileSizes, InTheJsonOfOurFile) {
  std::set<std::string> tried;
  using testing::glb_json;
  using testing::with_glb_json;
  for (const testing::GlbKind& kind : testing::glb_kinds()) {
    const Bytes bytes = testing::glb_bytes(testing::random_scene(kind, 1, 2), kind.name);
    const nlohmann::json whole = glb_json(bytes);
    const auto refuse = [&](const std::string& pointer, std::uint64_t size) {
      const nlohmann::json::json_pointer at(pointer);
      if (!whole.contains(at)) return;
      tried.insert(pointer);
      nlohmann::json changed = whole;
      changed[at] = size;
      const Bytes damaged = with_glb_json(bytes, changed);
      expect_refused([&] { fuzz::gltf(damaged); },
                     std::string(kind.name) + pointer + " = " + std::to_string(size),
                     // Elements; or what they are made of, three corners and eight bytes.
                     AnyOf(HasSubstr(std::to_string(size)), HasSubstr(std::to_string(3 * size)),
                           HasSubstr(std::to_string(8 * size))));
    };
    const std::string extension = "/extensions/TUREEN_triangle_soup";
    for (const std::uint64_t size : false_sizes) {
      for (const char* key : {"/vertex_count", "/face_count", "/appearance/texel_count",
                              "/appearance/degree", "/appearance/strips/0/count"})
        refuse(extension + key, size);
      for (std::size_t i = 0; i < whole["accessors"].size(); ++i)
        // Not those of the mesh that other viewers see, which we do not read.
        if (whole["accessors"][i].value("name", "").empty() && i + 1 == whole["accessors"].size())
          refuse("/accessors/" + std::to_string(i) + "/count", size);
    }
  }
  // Each was there in one kind of file at least.
  for (const char* key : {"/vertex_count", "/face_count", "/appearance/texel_count",
                          "/appearance/degree", "/appearance/strips/0/count"})
    EXPECT_TRUE(tried.contains(std::string("/extensions/TUREEN_triangle_soup") + key)) << key;
  EXPECT_TRUE(std::any_of(tried.begin(), tried.end(),
                          [](const std::string& at) { return at.rfind("/accessors/", 0) == 0; }));
}

TEST(HostileSizes, InTheJsonOfForeignFiles) {
  for (const fuzz::Fixture& fixture : fuzz::fixtures()) {
    if (fixture.name != "foreign.gltf") continue;
    const auto whole = nlohmann::json::parse(text_of(fixture.bytes));
    for (const char* pointer :
         {"/accessors/1/count", "/accessors/3/count", "/accessors/0/sparse/count",
          "/accessors/3/byteOffset", "/bufferViews/2/byteLength", "/bufferViews/2/byteOffset",
          "/bufferViews/2/byteStride", "/buffers/0/byteLength", "/nodes/0/mesh",
          "/meshes/0/primitives/0/indices", "/textures/0/source"})
      for (const std::uint64_t size : false_sizes) {
        nlohmann::json changed = whole;
        changed[nlohmann::json::json_pointer(pointer)] = size;
        const std::string text = changed.dump();
        expect_refused([&] { fuzz::gltf(bytes_of(text)); },
                       std::string(pointer) + " = " + std::to_string(size),
                       AnyOf(HasSubstr(std::to_string(size)), HasSubstr("is beyond 2147483647")));
      }
    return;
  }
  FAIL() << "there is no foreign.gltf";
}

TEST(HostileSizes, OfTensors) {
  using testing::TensorFixture;
  for (const std::uint64_t size : {std::uint64_t(1) << 30, std::uint64_t(0x7fffffff)}) {
    for (const std::vector<std::uint64_t>& shape :
         {std::vector<std::uint64_t>{size, 3, 3}, {size, size, size}, {2, 3, size}}) {
      TensorFixture points = TensorFixture::floats({2, 3, 3}, std::vector<float>(18));
      points.shape = shape;
      testing::TorchFixture torch;
      torch.add("triangles_points", points);
      const std::string bytes = torch.bytes();
      expect_refused(
          [&] { read_checkpoint(Input::memory("a.pt", std::as_bytes(std::span(bytes)))); }, "shape",
          AnyOf(HasSubstr(std::to_string(size)),
                HasSubstr("\"triangles_points\" has a shape, stride or offset that is none")));
    }
  }
}

// ---- What unfolds

TEST(HostileBombs, APictureThatUnfoldsBeyondItsPixels) {
  // A pixel, and 64 MB of zeros behind it that are a few kilobytes in the file.
  const Bytes bomb = fuzz::PngFixture{.rows = std::string(64 << 20, '\0')}.bytes();
  EXPECT_LT(bomb.size(), 100u << 10);
  within_bounds(
      default_max_memory,
      [&] {
        const MemoryMeter meter;
        EXPECT_THAT(
            input_error([&] { decode_image(bomb, "bomb.png"); }),
            HasSubstr("bomb.png: the image is damaged: it unfolds to more than its pixels"));
        EXPECT_LT(meter.peak(), uncounted);
      },
      "bomb");
}

TEST(HostileBombs, APictureOfMorePixelsThanMemory) {
  // 6,000 x 6,000 pixels of nothing: 144 MB that are some kB in the file.
  const Bytes large =
      fuzz::PngFixture{
          .width = 6000, .height = 6000, .color_type = 0, .rows = std::string(6001u * 6000u, '\0')}
          .bytes();
  EXPECT_LT(large.size(), 1u << 20);
  within_bounds(
      128 << 20,
      [&] {
        EXPECT_THAT(
            input_error([&] { decode_image(large, "large.png"); }),
            HasSubstr("large.png: an image of 6000 x 6000 would take more than the 128 MB"));
      },
      "large");
  const Bytes beyond =
      fuzz::PngFixture{.width = 20000, .height = 20000, .color_type = 0, .rows = "x"}.bytes();
  EXPECT_THAT(input_error([&] { decode_image(beyond, "beyond.png"); }),
              HasSubstr("20000 x 20000 pixels is beyond what we read: 65536 pixels a side and "
                        "268435456 in all"));
  // So large that stb itself refuses it.
  const Bytes farther =
      fuzz::PngFixture{.width = 30000, .height = 30000, .color_type = 2, .rows = "x"}.bytes();
  EXPECT_THAT(input_error([&] { decode_image(farther, "farther.png"); }),
              HasSubstr("farther.png: an image of 30000 x 30000 pixels is beyond what we read"));
  const Bytes longer =
      fuzz::PngFixture{.width = 20000000, .height = 1, .color_type = 2, .rows = "x"}.bytes();
  EXPECT_THAT(input_error([&] { decode_image(longer, "longer.png"); }),
              HasSubstr("longer.png: an image of 20000000 x 1 pixels is beyond what we read"));
}

TEST(HostileBombs, ManyPicturesInOneScene) {
  // Each would fit; a hundred do not.
  const Bytes picture =
      fuzz::PngFixture{
          .width = 1000, .height = 1000, .color_type = 0, .rows = std::string(1001u * 1000u, '\0')}
          .bytes();
  const TemporaryFolder folder;
  testing::write_bytes(folder / "a.png", picture);
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
  testing::write_text(folder / "a.gltf", gltf.dump());
  within_bounds(
      64 << 20,
      [&] {
        EXPECT_THAT(input_error([&] { read_scene(folder / "a.gltf"); }),
                    AllOf(HasSubstr("a.gltf: images["), HasSubstr("--max-memory changes that")));
      },
      "a hundred");
}

TEST(HostileBombs, AnArchiveThatInflatesBeyondItsSizes) {
  const std::string zeros(32 << 20, '\0');
  const std::string packed = testing::ZipFixture::deflated(zeros);
  EXPECT_LT(packed.size(), 1u << 20);
  // Says what it holds, says less, and says more than deflate can.
  for (const std::uint64_t claimed :
       {std::uint64_t(zeros.size()), std::uint64_t(1000), std::uint64_t(0x7fffffff)}) {
    testing::ZipFixture zip;
    zip.entries.push_back({"a/data.pkl", zeros, true});
    std::string bytes = zip.bytes();
    const auto size = std::uint32_t(claimed);
    const std::size_t directory = bytes.rfind(std::string("PK\1\2"));
    std::memcpy(&bytes[directory + 24], &size, sizeof size);
    within_bounds(
        8 << 20,
        [&] {
          EXPECT_NE(input_error([&] {
                      read_checkpoint(Input::memory("bomb.pt", std::as_bytes(std::span(bytes))));
                    }),
                    "")
              << claimed;
        },
        "an archive");
  }
}

TEST(HostileBombs, PicklesThatDoubleThemselves) {
  // A list of two of the list before, forty times over: 2^40 elements for whoever walks it.
  testing::PickleFixture pickle;
  pickle.op("]q").op(std::string(1, '\0'));
  for (int i = 1; i < 40; ++i) {
    pickle.op("](h").op(std::string(1, char(i - 1))).op("h").op(std::string(1, char(i - 1)));
    pickle.op("eq").op(std::string(1, char(i)));
  }
  // All lie on the stack; the pickle is refused for that, or read without being walked.
  within_bounds(
      1 << 20, [&] { input_error([&] { fuzz::pickle(bytes_of(pickle.done())); }); },
      "billion laughs");
}

// ---- JSON

struct JsonReader {
  const char* name;
  void (*read)(const std::string& text, const fs::path& folder);
};

void read_in_folder(const fs::path& folder, const fuzz::FolderFiles& files, const char* name,
                    const std::string& text) {
  for (const auto& [file, bytes] : files) testing::write_bytes(folder / file, bytes);
  testing::write_text(folder / name, text);
  read_scene(folder);
}

const std::array<JsonReader, 14> json_readers{{
    {"cameras", [](const std::string& text, const fs::path&) { fuzz::cameras(bytes_of(text)); }},
    {"path", [](const std::string& text, const fs::path&) { fuzz::camera_path(bytes_of(text)); }},
    {"session", [](const std::string& text, const fs::path&) { fuzz::session(bytes_of(text)); }},
    {"transforms",
     [](const std::string& text, const fs::path&) { fuzz::transforms(bytes_of(text)); }},
    {"bench.json",
     [](const std::string& text, const fs::path&) { fuzz::bench_result(bytes_of(text)); }},
    {"bench of a page",
     [](const std::string& text, const fs::path&) { fuzz::web_bench(bytes_of(text)); }},
    {"configuration",
     [](const std::string& text, const fs::path&) { fuzz::training_config(bytes_of(text)); }},
    {"log of a run",
     [](const std::string& text, const fs::path&) { fuzz::training_log(bytes_of(text + "\n")); }},
    {"gltf", [](const std::string& text, const fs::path&) { fuzz::gltf(bytes_of(text)); }},
    {"glb",
     [](const std::string& text, const fs::path&) {
       std::string padded = text;
       padded.append((4 - padded.size() % 4) % 4, ' ');
       const std::uint32_t head[] = {0x46546C67, 2, std::uint32_t(20 + padded.size()),
                                     std::uint32_t(padded.size()), 0x4E4F534A};
       Bytes bytes(sizeof head + padded.size());
       std::memcpy(bytes.data(), head, sizeof head);
       std::memcpy(bytes.data() + sizeof head, padded.data(), padded.size());
       fuzz::gltf(bytes);
     }},
    {"meta.json",
     [](const std::string& text, const fs::path& folder) {
       read_in_folder(folder, fuzz::diffsoup_files(), "meta.json", text);
     }},
    {"mlp_weights.json",
     [](const std::string& text, const fs::path& folder) {
       read_in_folder(folder, fuzz::diffsoup_files(), "mlp_weights.json", text);
     }},
    {"mlp.json",
     [](const std::string& text, const fs::path& folder) {
       read_in_folder(folder, fuzz::mobilenerf_files(), "mlp.json", text);
     }},
    {"small files",
     [](const std::string& text, const fs::path&) {
       Input input = testing::input_of(text, "a.json");
       read_json(input, RepeatedKeys::refused);
     }},
}};

/// {"asset": {"version": "2.0"}, "extras": [[[..]]]}, which any reader takes for what it reads.
std::string nested(int depth, char open, char close) {
  std::string text = R"({"asset": {"version": "2.0"}, "extras": )";
  for (int i = 0; i < depth; ++i)
    text += open == '{' ? std::string("{\"a\":") : std::string(1, open);
  text += "1" + std::string(std::size_t(depth), close) + "}";
  return text;
}

TEST(HostileJson, NestedDeeperThanOurLimitIsRefusedEverywhere) {
  for (const JsonReader& reader : json_readers)
    for (const std::pair<char, char>& ends : {std::pair('[', ']'), std::pair('{', '}')}) {
      const TemporaryFolder folder;
      SCOPED_TRACE(reader.name);
      const auto read = [&](int depth) {
        return input_error(
            [&] { reader.read(nested(depth, ends.first, ends.second), folder / ""); });
      };
      for (const int depth : {64, 65, 1000, 1000000}) {
        within_bounds(
            default_max_memory,
            [&] {
              // With the place: a log of lines names the line.
              EXPECT_THAT(read(depth), AllOf(HasSubstr("JSON nested deeper than 64 levels"),
                                             AnyOf(HasSubstr("byte"), HasSubstr(".jsonl:1: "))));
            },
            "depth");
      }
      // One less is not refused for its depth.
      EXPECT_THAT(read(63), ::testing::Not(HasSubstr("nested deeper")));
    }
}

TEST(HostileJson, OfMoreValuesThanMemoryIsRefusedBeforeItIsParsed) {
  std::string text = R"({"asset": {"version": "2.0"}, "materials": [)";
  for (int i = 0; i < 1000000; ++i) text += i ? ",{}" : "{}";
  text += "]}";
  within_bounds(
      64 << 20,
      [&] {
        EXPECT_THAT(input_error([&] { fuzz::gltf(bytes_of(text)); }),
                    HasSubstr("the JSON would take more than the 64 MB"));
      },
      "materials");
}

TEST(HostileJson, NamesOfMembersMayBeAnythingAtAnyLength) {
  const std::string head = R"({"asset": {"version": "2.0"}, "nodes": [{")";
  const auto read = [&](const std::string& name, const std::string& value) {
    return input_error([&] { fuzz::gltf(bytes_of(head + name + "\": " + value + "}]}")); });
  };
  // The letter 0 ends names in C.
  EXPECT_THAT(read("a\\u0000b", "[4294967296]"), ::testing::Not(HasSubstr("beyond")));
  const std::string named = input_error([&] {
    fuzz::gltf(bytes_of(R"({"asset": {"version": "2.0\u0000\n", "minVersion": "a\u0000b\nc"}})"));
  });
  EXPECT_THAT(named, HasSubstr("a?b?c; 2.0 is read"));
  EXPECT_THAT(read("mesh", "4294967296"), HasSubstr("nodes[0].mesh: is beyond 2147483647"));
  EXPECT_THAT(read("mesh", "-4294967295"), HasSubstr("nodes[0].mesh: is beyond 2147483647"));
  EXPECT_THAT(read("children", "[0, 4294967296]"), HasSubstr("nodes[0].children[1]: is beyond"));
  // A long name above many values: what is put together for each of them would be terabytes.
  std::string many = "[0";
  for (int i = 0; i < 500000; ++i) many += ",0";
  within_bounds(
      default_max_memory, [&] { read(std::string(1 << 20, 'a'), many + "]"); }, "long name");
}

TEST(HostileJson, NumbersThatNoDoubleHoldsAreRefused) {
  for (const char* number : {"1e999", "-1e999"}) {
    const std::string text =
        R"({"asset": {"version": "2.0"}, "frames": [)" + std::string(number) + "]}";
    EXPECT_THAT(input_error([&] { parse_json(text, "a.json"); }), HasSubstr(number));
    for (const JsonReader& reader : json_readers) {
      const TemporaryFolder folder;
      EXPECT_THAT(input_error([&] { reader.read(text, folder / ""); }), HasSubstr(number))
          << reader.name;
    }
  }
}

// ---- Names

/// Tells whether a file was opened while this lives.
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
  testing::write_text(folder / "a", "text");
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
    testing::write_picture(folder / "outside.png", testing::a_picture(8, 6));
    testing::write_bytes(folder / "outside.bin", Bytes(36));
    testing::write_picture(folder / "scene/inside.png", testing::a_picture(8, 6));
    testing::write_bytes(folder / "scene/inside.bin", Bytes(36));
    fs::create_symlink(folder / "outside.png", folder / "scene/link.png");
    fs::create_symlink(folder / "outside.bin", folder / "scene/link.bin");
    fs::create_symlink(folder / "", folder / "scene/up");
  }
  TemporaryFolder folder;
};

TEST_F(HostileNames, OfAGltfDoNotLeadOutOfItsFolder) {
  const Tripwire picture(folder / "outside.png"), bytes(folder / "outside.bin");
  testing::write_text(folder / "scene/a.gltf", gltf_with_uri("images", "inside.png"));
  EXPECT_EQ(input_error([&] { read_scene(folder / "scene/a.gltf"); }), "");
  for (const auto& [list, extension] : {std::pair("images", ".png"), std::pair("buffers", ".bin")})
    for (const std::string& name :
         {std::string("../outside"), std::string("x/../../outside"), std::string("%2e%2e/outside"),
          std::string("..\\outside"), (folder / "outside").string(),
          "file://" + (folder / "outside").string(), std::string("link"), std::string("up/outside"),
          std::string("up/scene/../outside")}) {
      testing::write_text(folder / "scene/a.gltf", gltf_with_uri(list, name + extension));
      EXPECT_THAT(input_error([&] { read_scene(folder / "scene/a.gltf"); }),
                  AllOf(HasSubstr("a.gltf"), HasSubstr(list)))
          << name;
    }
  EXPECT_FALSE(picture.was_opened());
  EXPECT_FALSE(bytes.was_opened());
}

TEST_F(HostileNames, OfAFolderOfFixedNamesDoNotLeadOutOfIt) {
  const auto lead_out = [&](const fuzz::FolderFiles& files) {
    for (const auto& [name, content] : files) {
      fs::remove_all(folder / "fixed");
      for (const auto& [file, bytes] : files)
        testing::write_bytes(folder / ("fixed/" + file), bytes);
      EXPECT_EQ(input_error([&] { read_scene(folder / "fixed"); }), "");
      testing::write_bytes(folder / "elsewhere", content);
      fs::remove(folder / ("fixed/" + name));
      fs::create_symlink("../elsewhere", folder / ("fixed/" + name));
      const Tripwire wire(folder / "elsewhere");
      EXPECT_THAT(input_error([&] { read_scene(folder / "fixed"); }),
                  HasSubstr("is a link that leads out of the scene's folder"))
          << name;
      EXPECT_FALSE(wire.was_opened()) << name;
      // A link within the folder is as good as a file.
      testing::write_bytes(folder / "fixed/other", content);
      fs::remove(folder / ("fixed/" + name));
      fs::create_symlink("other", folder / ("fixed/" + name));
      EXPECT_EQ(input_error([&] { read_scene(folder / "fixed"); }), "") << name;
    }
  };
  lead_out(fuzz::diffsoup_files());
  lead_out(fuzz::mobilenerf_files());
}

TEST_F(HostileNames, OfPhotographsDoNotLeadOutOfTheDataset) {
  const Tripwire picture(folder / "outside.png");
  for (const char* name : {"../outside.png", "x/../../outside.png", "link.png", "up/outside.png"}) {
    const std::string frame = std::string(R"({"file_path": ")") + name + R"(",
      "transform_matrix": [[1,0,0,0],[0,1,0,0],[0,0,1,2],[0,0,0,1]]})";
    testing::write_text(folder / "scene/transforms.json",
                        R"({"camera_angle_x": 0.7, "frames": [)" + frame + "," + frame + "]}");
    EXPECT_THAT(input_error([&] { read_dataset(folder / "scene"); }),
                AllOf(HasSubstr("transforms.json"), HasSubstr("leads out of the scene's folder")))
        << name;
    fs::remove(folder / "scene/transforms.json");
    testing::ColmapFixture model = testing::upright_colmap(2);
    for (auto& image : model.images) image.name = std::string("../") + name;
    testing::write_text(folder / "scene/sparse/0", model);
    fs::create_directories(folder / "scene/images");
    EXPECT_THAT(input_error([&] { read_dataset(folder / "scene"); }),
                HasSubstr("leads out of the scene's folder"));
    fs::remove_all(folder / "scene/sparse");
  }
  EXPECT_FALSE(picture.was_opened());
}

TEST_F(HostileNames, ThatAreNotUtf8EndInAnErrorOrAreReadAsTheyAre) {
  const std::string odd = "\xff\xfe\xc3(.off";
  testing::write_text(folder / odd, "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
  EXPECT_EQ(testing::soup_of(read_scene(folder / odd)).triangles.size(), 1u);
  testing::write_text(folder / odd, "OFF\n3 1 0\n");
  EXPECT_THAT(input_error([&] { read_scene(folder / odd); }), HasSubstr(odd));
  // In JSON they are no JSON.
  testing::write_text(folder / "scene/a.gltf",
                      "{\"asset\": {\"version\": \"2.0\"}, \"images\": [{\"uri\": \"\xff.png\"}]}");
  EXPECT_THAT(input_error([&] { read_scene(folder / "scene/a.gltf"); }),
              HasSubstr("not valid JSON"));
  // COLMAP's names are bytes.
  testing::ColmapFixture model = testing::upright_colmap(2);
  model.images[0].name = "\xff\xfe.png";
  testing::write_binary(folder / "scene/sparse/0", model);
  for (const std::string& name : {model.images[0].name, model.images[1].name})
    testing::write_picture(folder / ("scene/images/" + name), testing::a_picture(8, 6));
  const Dataset dataset = read_dataset(folder / "scene");
  EXPECT_EQ(dataset.test.size() + dataset.train.size(), 2u);
  cameras_to_json(std::array{dataset.train[0].camera, dataset.test[0].camera});
  // A name of 5000 letters, of which the message shows some.
  testing::write_text(folder / "long.ply", "ply\nformat ascii 1.0\nelement " +
                                               std::string(5000, '\xff') + " 1 1\nend_header\n");
  EXPECT_LT(input_error([&] { read_scene(folder / "long.ply"); }).size(), 1000u);
}

}  // namespace
}  // namespace tureen
