// Files that state false sizes, 2^31 and 2^63 among them. The error names the size or the
// contradicting value, and the reader allocates nothing by the size.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>

#include "formats/archive/zip_archive.hpp"
#include "formats/mesh/off.hpp"
#include "formats/ply_file.hpp"
#include "formats/scene_file.hpp"
#include "formats/torch/checkpoint.hpp"
#include "formats/tureen_glb/compressed_geometry.hpp"
#include "formats/tureen_glb/compressed_texels.hpp"
#include "tests/formats/dataset/dataset_fixture.hpp"
#include "tests/formats/hostile_bounds.hpp"
#include "tests/formats/torch_fixture.hpp"
#include "tests/formats/tureen_glb/tureen_glb_kinds.hpp"
#include "tests/fuzz/fixtures.hpp"
#include "tests/fuzz/folder_files.hpp"
#include "tests/fuzz/targets.hpp"
#include "tests/support/errors.hpp"
#include "trainer/diffsoup/model.hpp"

namespace tureen {
namespace hostile_sizes_test {

using test::Bytes;
using test::bytes_of;
using test::error_of;
using test::ErrorAt;
using test::ErrorIn;
using test::expect_refused;
using test::Names;
using test::TemporaryFolder;
using test::text_of;
using ::testing::AnyOf;

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
            Input input = test::input_of(text, "a.off");
            read_off(input);
          },
          text, AnyOf(ErrorIn("a.off", n), ErrorAt("a.off:6")));
    // At least three vertices in every encoding.
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
              Input input = test::input_of(text, "a.ply");
              read_ply(input);
            },
            text, ErrorIn("a.ply", n));
      }
    const std::string obj = "v 0 0 0\nvt 0 0\nf " + n + "/1 1/1 1/1\n";
    expect_refused([&] { fuzz::obj(bytes_of(obj)); }, obj, ErrorAt("fuzz.obj:3", n));
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
      // Count of records.
      for (const std::uint64_t size : false_sizes) {
        Bytes bytes = fixture.bytes;
        put(bytes, 1, size);
        expect_refused([&] { fuzz::colmap_binary(bytes); }, fixture.name, Names(size));
      }
    } else if (fixture.name == "face_bytes.glb") {
      // Lengths of the file and of the JSON chunk.
      for (const std::size_t at : {8, 12})
        for (const std::uint32_t size : {0x80000000u, 0xfffffffcu}) {
          Bytes bytes = fixture.bytes;
          put(bytes, at, size);
          expect_refused([&] { fuzz::gltf(bytes); }, fixture.name, Names(size));
        }
    } else if (fixture.name == "rgba.png") {
      for (const std::size_t at : {16, 20})
        for (const auto& [size, side] : {std::pair(0x80u, "2147483648"),
                                         std::pair(0xffffff7fu, "2147483647")}) {  // big endian
          Bytes bytes = fixture.bytes;
          put(bytes, at, size);
          expect_refused([&] { fuzz::image(bytes); }, fixture.name, ErrorIn("fuzz.png", side));
        }
      // Lengths of the first chunk and of the pixels' chunk: some above the maximum of stb, one
      // below it.
      for (const std::size_t at : {8, 33})
        for (const std::uint32_t size : {0x80u, 0xffffff7fu, 0xffffffffu, 0x40u}) {  // big endian
          Bytes bytes = fixture.bytes;
          put(bytes, at, size);
          expect_refused([&] { fuzz::image(bytes); }, fixture.name,
                         ErrorAt("fuzz.png@" + std::to_string(at)));
        }
    }
  }
  for (const char* name : {"colmap_binary", "face_bytes.glb", "rgba.png"})
    EXPECT_TRUE(tried.contains(name)) << name;
}

/// Offsets of the counts of a checkpoint, with their names. The layout is a second, manual copy of
/// the one in trainer/diffsoup/checkpoint.hpp.
std::vector<std::pair<const char*, std::size_t>> counts_of_checkpoint(const Bytes& bytes) {
  std::vector<std::pair<const char*, std::size_t>> counts;
  std::size_t at = 8 + 4;  // after the magic and the version
  const auto count = [&](const char* what, std::size_t each) {
    std::uint64_t value = 0;
    EXPECT_LE(at + sizeof value, bytes.size()) << what;
    if (at + sizeof value > bytes.size()) return;
    std::memcpy(&value, &bytes[at], sizeof value);
    counts.emplace_back(what, at);
    at += sizeof value + each * value;
  };
  constexpr std::size_t number = 4, vector = 3 * number, mlp = sizeof(trainer::MlpParameters);
  count("the configuration", 1);
  count("the number of views", 0);  // one view
  count("the name of a view", 1);
  at += 4 * number + 8;  // its sides and sums; the seconds
  at += number;          // the step
  count("the errors of the faces", number);
  count("the baseline", 2);
  at += 8 + 2 * number;  // quarantined numbers, two levels
  count("the positions", vector);
  count("the texels", number);
  at += mlp + 3 * 8;  // the origin
  count("the first moments of the texels", number);
  count("the second moments of the texels", number);
  count("the first moments of the positions", vector);
  count("the second moments of the positions", number);
  count("the steps of the faces", number);
  EXPECT_EQ(at + 2 * mlp + number, bytes.size());
  return counts;
}

TEST(HostileSizes, OfCheckpointsOfTraining) {
  std::size_t tried = 0;
  for (const fuzz::Fixture& fixture : fuzz::fixtures()) {
    if (fixture.name != "run.checkpoint") continue;
    for (const auto& [what, at] : counts_of_checkpoint(fixture.bytes))
      for (const std::uint64_t size : false_sizes) {
        ++tried;
        Bytes bytes = fixture.bytes;
        std::memcpy(&bytes[at], &size, sizeof size);
        expect_refused([&] { fuzz::training_checkpoint(bytes); },
                       std::string(what) + " " + std::to_string(size), ErrorIn("fuzz.checkpoint"));
      }
  }
  EXPECT_EQ(tried, 12 * false_sizes.size());
}

TEST(HostileSizes, InTheJsonOfOurFile) {
  std::set<std::string> tried;
  using test::glb_json;
  using test::with_glb_json;
  for (const test::GlbKind& kind : test::glb_kinds()) {
    const Bytes bytes = test::glb_bytes(test::random_scene(kind, 1, 2), kind.name);
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
                     // The number of elements, or of their parts: three corners and eight bytes.
                     AnyOf(Names(size), Names(3 * size), Names(8 * size)));
    };
    const std::string extension = "/extensions/TUREEN_triangle_soup";
    for (const std::uint64_t size : false_sizes) {
      for (const char* key : {"/vertex_count", "/face_count", "/appearance/texel_count",
                              "/appearance/degree", "/appearance/strips/0/count"})
        refuse(extension + key, size);
      for (std::size_t i = 0; i < whole["accessors"].size(); ++i)
        // The other accessors belong to the mesh for other viewers, which the reader ignores.
        if (whole["accessors"][i].value("name", "").empty() && i + 1 == whole["accessors"].size())
          refuse("/accessors/" + std::to_string(i) + "/count", size);
    }
  }
  // At least one kind of file has each of these.
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
                       AnyOf(Names(size), Names(2147483647)));
      }
    return;
  }
  FAIL() << "no fixture foreign.gltf";
}

TEST(HostileSizes, OfTensors) {
  using test::TensorFixture;
  std::vector<std::uint64_t> sizes{std::uint64_t(1) << 30, 0x7fffffff,
                                   (std::uint64_t(1) << 63) - 1};
  sizes.insert(sizes.end(), false_sizes.begin(), false_sizes.end());
  const auto points = [] { return TensorFixture::floats({2, 3, 3}, std::vector<float>(18)); };
  for (const std::uint64_t size : sizes) {
    std::vector<TensorFixture> damaged;
    for (const std::vector<std::uint64_t>& shape :
         {std::vector<std::uint64_t>{size, 3, 3}, {size, size, size}, {2, 3, size}}) {
      damaged.push_back(points());
      damaged.back().shape = shape;
      damaged.back().strides = {9, 3, 1};
      damaged.push_back(points());
      damaged.back().strides = shape;
    }
    damaged.push_back(points());
    damaged.back().offset = size;
    damaged.push_back(points());
    damaged.back().stored = size;
    for (std::size_t i = 0; i < damaged.size(); ++i) {
      test::TorchFixture torch;
      torch.add("triangles_points", damaged[i]);
      const std::string bytes = torch.bytes();
      expect_refused([&] { read_checkpoint(Input::memory("a.pt", test::as_bytes(bytes))); },
                     "tensor " + std::to_string(i) + " of " + std::to_string(size),
                     // The pickle reader has no integers above 63 bits.
                     size >> 63 ? Names("LONG1", 9) : Names("triangles_points"));
    }
  }
}

/// Sizes of 64 bits are in the directory's extra field and in the record after the directory.
TEST(HostileSizes, OfArchives) {
  const auto damaged = [](bool deflate, const char* signature, std::size_t at, std::uint64_t size) {
    test::ZipFixture zip;
    zip.zip64 = true;
    zip.entries.push_back({"a/data.pkl", std::string(300, 'x'), deflate});
    std::string bytes = zip.bytes();
    std::memcpy(&bytes.at(bytes.rfind(signature) + at), &size, sizeof size);
    return bytes;
  };
  // After the directory's record, the name and the field's header.
  constexpr std::size_t extra = 46 + 10 + 4;
  const struct {
    const char* signature;
    std::size_t at;
    bool deflate;
    bool names_size = false;
  } fields[] = {
      {"PK\1\2", extra, false},      {"PK\1\2", extra, true},     {"PK\1\2", extra + 8, false},
      {"PK\1\2", extra + 16, false}, {"PK\6\6", 32, false, true}, {"PK\6\6", 40, false},
      {"PK\6\6", 48, false},         {"PK\6\7", 8, false, true},
  };
  for (const auto& field : fields)
    for (const std::uint64_t size : false_sizes) {
      const std::string bytes = damaged(field.deflate, field.signature, field.at, size);
      expect_refused([&] { ZipArchive(Input::memory("a.pt", test::as_bytes(bytes))); },
                     field.signature + std::to_string(field.at) + " = " + std::to_string(size),
                     field.names_size ? ErrorIn("a.pt", size) : ErrorIn("a.pt"));
    }
  EXPECT_EQ(error_of([&] {
              const std::string bytes = damaged(false, "PK\1\2", extra, 300);
              ZipArchive(Input::memory("a.pt", test::as_bytes(bytes)));
            }),
            std::nullopt)
      << "the undamaged archive is readable";
}

/// Finds the paths of members with these names, at any depth.
void find_members(const nlohmann::json& json, const std::set<std::string>& names,
                  const nlohmann::json::json_pointer& at,
                  std::vector<nlohmann::json::json_pointer>& found) {
  for (const auto& [key, value] : json.items()) {
    const auto here = json.is_array() ? at / std::size_t(std::stoul(key)) : at / key;
    if (json.is_object() && names.contains(key)) found.push_back(here);
    if (value.is_structured()) find_members(value, names, here, found);
  }
}

TEST(HostileSizes, OfCameras) {
  std::set<std::string> tried;
  for (const fuzz::Fixture& fixture : fuzz::fixtures()) {
    const auto* target = std::find_if(
        std::begin(fuzz::targets), std::end(fuzz::targets),
        [&](const fuzz::Target& candidate) { return candidate.name == fixture.target; });
    if (fixture.target == "cameras" || fixture.target == "transforms" ||
        fixture.target == "camera_path") {
      const auto whole = nlohmann::json::parse(text_of(fixture.bytes));
      std::vector<nlohmann::json::json_pointer> sides;
      find_members(whole, {"width", "height", "w", "h"}, nlohmann::json::json_pointer(), sides);
      for (const auto& side : sides)
        for (const std::uint64_t size : false_sizes) {
          tried.insert(fixture.target + "/" + side.back());
          nlohmann::json changed = whole;
          changed[side] = size;
          const Bytes bytes = bytes_of(changed.dump());
          expect_refused([&] { target->read(bytes); },
                         fixture.name + side.to_string() + " = " + std::to_string(size),
                         Names(side.back(), 65536));
        }
    } else if (fixture.target == "colmap_binary" && fixture.name == "cameras") {
      // After the file's kind and the count: number, model, width and height.
      for (const std::size_t at : {1 + 8 + 8, 1 + 8 + 16})
        for (const std::uint64_t size : false_sizes) {
          tried.insert(fixture.target);
          Bytes bytes = fixture.bytes;
          std::memcpy(&bytes.at(at), &size, sizeof size);
          expect_refused([&] { target->read(bytes); }, fixture.name, Names(size));
        }
    } else if (fixture.target == "colmap_text" && fixture.name == "cameras") {
      for (const std::string side : {" 8 ", " 6 "})
        for (const std::uint64_t size : false_sizes) {
          tried.insert(fixture.target);
          std::string text = text_of(fixture.bytes);
          const std::size_t at = text.find(side);
          ASSERT_NE(at, std::string::npos);
          text.replace(at, side.size(), " " + std::to_string(size) + " ");
          expect_refused([&] { target->read(bytes_of(text)); }, text, Names(size));
        }
    }
  }
  EXPECT_THAT(tried,
              ::testing::IsSupersetOf({"cameras/width", "cameras/height", "cameras/w", "cameras/h",
                                       "transforms/w", "transforms/h", "camera_path/width",
                                       "camera_path/height", "colmap_binary", "colmap_text"}));
}

/// Members with these names are counts, sides or list indices, alone or in lists.
TEST(HostileSizes, InTheJsonOfRunsAndMeasurements) {
  const std::map<std::string, std::set<std::string>> members{
      {"session", {"window", "resize", "code_point"}},
      {"training_config",
       {"steps", "batch", "triangles", "initial_triangles", "coarse_level", "min_level",
        "max_level", "resample_every", "split_views", "least_views"}},
      {"bench_result",
       {"cores", "width", "height", "views", "rounds", "frames_per_sample", "frames"}},
      {"web_bench",
       {"cores", "screen_width", "screen_height", "width", "height", "frames_per_sample"}}};
  std::set<std::string> tried;
  for (const fuzz::Fixture& fixture : fuzz::fixtures()) {
    const auto names = members.find(fixture.target);
    if (names == members.end()) continue;
    const auto* target = std::find_if(
        std::begin(fuzz::targets), std::end(fuzz::targets),
        [&](const fuzz::Target& candidate) { return candidate.name == fixture.target; });
    auto whole = nlohmann::json::parse(text_of(fixture.bytes));
    // A configuration contains only the members that it changes.
    if (fixture.target == "training_config")
      for (const std::string& name : names->second) whole.emplace(name, 1);
    std::vector<nlohmann::json::json_pointer> found;
    find_members(whole, names->second, nlohmann::json::json_pointer(), found);
    for (const auto& member : found) {
      const nlohmann::json::json_pointer at = whole[member].is_array() ? member / 0 : member;
      if (!whole[at].is_number()) continue;
      for (const std::uint64_t size : false_sizes) {
        tried.insert(fixture.target + "/" + member.back());
        nlohmann::json changed = whole;
        changed[at] = size;
        const Bytes bytes = bytes_of(changed.dump());
        expect_refused([&] { target->read(bytes); },
                       fixture.name + at.to_string() + " = " + std::to_string(size),
                       Names(member.back()));
      }
    }
  }
  for (const auto& [target, names] : members)
    for (const std::string& name : names)
      EXPECT_TRUE(tried.contains(target + "/" + name)) << target << " " << name;
}

TEST(HostileSizes, InTheFilesOfAFolder) {
  const TemporaryFolder folder;
  for (const auto& [name, bytes] : fuzz::diffsoup_files()) test::write_bytes(folder / name, bytes);
  const auto whole = nlohmann::json::parse(text_of(Input::open(folder / "meta.json").read_rest()));
  for (const char* key : {"num_faces", "num_verts", "level"}) {
    ASSERT_TRUE(whole.contains(key));
    for (const std::uint64_t size : false_sizes) {
      nlohmann::json changed = whole;
      changed[key] = size;
      test::write_text(folder / "meta.json", changed.dump());
      expect_refused(
          [&] { read_scene(folder / ""); }, key + std::to_string(size),
          std::string_view(key) == "level" ? Names("level", 7) : Names("meta.json", size));
    }
  }
}

TEST(HostileSizes, OfMobileNerf) {
  const TemporaryFolder folder;
  for (const auto& [name, bytes] : fuzz::mobilenerf_files())
    test::write_bytes(folder / name, bytes);
  const auto whole = nlohmann::json::parse(text_of(Input::open(folder / "mlp.json").read_rest()));
  ASSERT_TRUE(whole.contains("obj_num"));
  for (const std::uint64_t size : false_sizes) {
    nlohmann::json changed = whole;
    changed["obj_num"] = size;
    test::write_text(folder / "mlp.json", changed.dump());
    expect_refused([&] { read_scene(folder / ""); }, std::to_string(size),
                   ErrorIn("mlp.json", "obj_num"));
  }
}

/// The numbers of faces and vertices are not in the coded bytes: the decoders get them separately.
TEST(HostileSizes, OfCompressedFiles) {
  std::set<std::string> tried;
  for (const fuzz::Fixture& fixture : fuzz::fixtures()) {
    if (fixture.name == "compressed.glb") {
      const nlohmann::json whole = test::glb_json(fixture.bytes);
      for (const char* key : {"vertex_count", "face_count"})
        for (const std::uint64_t size : false_sizes) {
          tried.insert(key);
          nlohmann::json changed = whole;
          changed["extensions"]["TUREEN_triangle_soup"][key] = size;
          const Bytes damaged = test::with_glb_json(fixture.bytes, changed);
          expect_refused([&] { fuzz::gltf(damaged); }, key + std::to_string(size),
                         ErrorIn("fuzz.glb"));
        }
    }
    const auto rest = [&](std::size_t head) { return std::span(fixture.bytes).subspan(head); };
    for (const std::uint64_t size : false_sizes) {
      if (fixture.target == "compressed_geometry") {
        tried.insert(fixture.target);
        const auto says = ErrorIn("a.glb");
        expect_refused([&] { decode_compressed_geometry(rest(2), size, 3, "a.glb"); }, "vertices",
                       says);
        expect_refused([&] { decode_compressed_geometry(rest(2), 3, size, "a.glb"); }, "faces",
                       says);
        expect_refused([&] { decode_compressed_geometry(rest(2), size, size, "a.glb"); }, "both",
                       says);
      } else if (fixture.target == "compressed_texels") {
        tried.insert(fixture.target);
        expect_refused([&] { decode_compressed_texels(rest(1), size, "a.glb"); }, "texels",
                       ErrorIn("a.glb"));
      }
    }
  }
  EXPECT_THAT(tried, ::testing::UnorderedElementsAre("vertex_count", "face_count",
                                                     "compressed_geometry", "compressed_texels"));
}

}  // namespace hostile_sizes_test
}  // namespace tureen
