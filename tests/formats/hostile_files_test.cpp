// Hostile files that others made: PngSuite's, the glTF validator's, tinygltf's and Magnum's, where
// their folder lies beside the repository. Each ends as it should, and nothing is written.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>

#include "formats/format_testing.hpp"
#include "formats/hostile_bounds.hpp"
#include "formats/png.hpp"
#include "formats/scene_file.hpp"

namespace tureen {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using testing::TemporaryFolder;
using testing::within_bounds;

/// The folder of hostile files beside the repository, where there is one.
fs::path hostile_files() { return TUREEN_SOURCE_DIR "/../shared/data/hostile"; }

std::map<fs::path, fs::file_time_type> listing(const fs::path& folder) {
  std::map<fs::path, fs::file_time_type> result;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    result[entry.path()] = entry.is_directory() ? fs::file_time_type() : entry.last_write_time();
  return result;
}

/// By its folder and name, what becomes of each file that is another thing than what `expected`
/// says of its kind: what the error says, or "" where it is read.
const std::map<std::string, std::string>& verdicts() {
  static const std::map<std::string, std::string> of_files{
      {"BoundsChecking/invalid-primitive-indices.gltf",
       "not valid glTF: primitive indices accessor out of bounds"},
      {"Cube-texture-ext/Cube-textransform.gltf", "no such file"},
      {"CubeImageUriSpaces/CubeImageUriSpaces.gltf", "no such file"},
      {"Test/colors-not-same-type.ply", "the file holds no triangles"},
      {"Test/colors-not-tightly-packed.ply", "the file holds no triangles"},
      {"Test/colors4-not-tightly-packed.ply", "the file holds no triangles"},
      {"Test/empty-le.ply", "the file holds no triangles"},
      {"Test/empty.ply", "the file holds no triangles"},
      {"Test/extra-token-face-element.ply", "'extradata' after a line of 'element'"},
      {"Test/extra-token-face-property.ply", "'extradata' after a line of 'property'"},
      {"Test/extra-token-vertex-element.ply", "'extradata' after a line of 'element'"},
      {"Test/extra-token-vertex-property.ply", "'extradata' after a line of 'property'"},
      {"Test/format-missing.ply", "'format' is expected after the first line"},
      {"Test/format-unsupported.ply", "the encoding 'binary_mixed_endian' is none that we know"},
      {"Test/integer-literal-too-large.ply",
       "the number of 'vertex' elements, 4294967296, is outside 0..4294967295"},
      {"Test/invalid-face-property.ply", "'extradata' after a line of 'property'"},
      {"Test/invalid-face-type.ply", "the type 'float16' is none that we know"},
      {"Test/invalid-vertex-property.ply", "'extradata' after a line of 'property'"},
      {"Test/normals-unsupported-type.ply", "the file holds no triangles"},
      {"Test/positions-missing.ply", "element 'vertex' lacks 'x'"},
      {"Test/positions-not-all.ply", "element 'vertex' lacks 'y'"},
      {"Test/texcoords-not-all.ply", "the file holds no triangles"},
      {"Test/texcoords-not-tightly-packed.ply", "the file holds no triangles"},
      {"accessor/empty_object.gltf",
       "not valid glTF: 'componentType' property is missing in Accessor"},
      {"accessor/unknown_type.gltf",
       "not valid glTF: Unsupported `type` for accessor object. Got \"NotaVEC3\""},
      {"asset/min_version_invalid.gltf", "asset.minVersion: glTF 2.1; 2.0 is read"},
      {"buffer_view/empty_object.gltf",
       "not valid glTF: 'buffer' property is missing in BufferView"},
      {"buffer_view/invalid_stride_multiple.gltf",
       "not valid glTF: Invalid `byteStride' value. `byteStride' must be the multiple of 4 : 5"},
      {"camera/empty_objects.gltf", "not valid glTF: 'type' property is missing in `Camera'"},
      {"glb/invalid_version.glb", "GLB version 0, only 2 is read"},
      {"glb/length_mismatch.glb", "the file is cut short: its header says 49 bytes, it has 48"},
      {"glb/misplaced_bin_chunk.glb", "the binary chunk is not the second"},
      {"glb/no_header.glb",
       "neither a GLB, which begins with \"glTF\", nor glTF, which is JSON with an \"asset\""},
      {"glb/only_bin_chunk.glb", "the first GLB chunk is not JSON"},
      {"glb/truncated_chunk_header.glb",
       "a GLB chunk header cut short: 4 bytes expected, 1 byte left"},
      {"glb/two_bin_chunks.glb", "the first GLB chunk is not JSON"},
      {"glb/zero_length.glb", "bytes trail the file: its header says 0 bytes, it has 12"},
      {"json/empty_file.gltf", "the file is empty"},
      {"json/invalid_syntax.gltf",
       "neither a GLB, which begins with \"glTF\", nor glTF, which is JSON with an \"asset\""},
      {"mesh/empty_object.gltf", "meshes[1].primitives: expected an array"},
      {"mesh/unresolved_indices.gltf", "not valid glTF: primitive indices accessor out of bounds"},
      {"models/box01.glb", ""},
      {"node/node_parent_override.gltf",
       "nodes[2]: is reached twice: it has two parents or is its own ancestor"},
      {"node/node_skinned_mesh_without_skin.gltf", ""},
      {"node/node_weights_invalid.gltf", ""},
      {"node/node_weights_override.gltf", ""},
      {"node/unresolved_camera.gltf", "nodes[0]: names camera 0 of 0"},
      {"node/unresolved_child_node.gltf", "nodes: there is no node 1 of 1"},
      {"off/empty.off", "the file is empty"},
      {"off/invalid.off", "the line ends where a vertex index is expected"},
      {"png/xcsn0g01.png", "a chunk's checksum is not that of its bytes"},
      {"png/xdtn0g01.png", "the image is damaged: no IDAT"},
      {"png/xhdn0g08.png", "a chunk's checksum is not that of its bytes"},
      {"regression/zero-sized-bin-chunk-issue-440.glb", ""},
      {"root/empty_object.gltf",
       "neither a GLB, which begins with \"glTF\", nor glTF, which is JSON with an \"asset\""},
      {"root/invalid_collection_type.gltf", "samplers: expected an array"},
      {"scene/unresolved_child_node.gltf", "nodes: there is no node 5 of 1"},
      {"scene/unresolved_default_scene.gltf", "scene: there is no scene 0 of 0"},
      {"skin/ignored_local_transform.gltf", ""},
      {"skin/ignored_parent_transform.gltf", ""},
      {"skin/no_joints_in_scene.gltf", ""},
  };
  return of_files;
}

/// What a file of these ends in.
std::string expected(const fs::path& file) {
  const auto found =
      verdicts().find((file.parent_path().filename() / file.filename()).generic_string());
  if (found != verdicts().end()) return found->second;
  const std::string extension = file.extension().string();
  // PngSuite's, of which those are broken whose names begin with an x.
  if (extension == ".png")
    return file.filename().string()[0] == 'x' ? "not a PNG or JPEG image: unknown image type" : "";
  // Most of the validator's have no mesh: what is wrong with them is elsewhere.
  if (extension == ".gltf" || extension == ".glb") return "the file holds no triangles";
  // Buffers and licences.
  if (extension == ".bin" || extension == ".txt") return "not a file of a kind that we read";
  return "";
}

/// An empty folder to work in, and another for what is temporary, while this lives.
class EmptyFolders {
 public:
  explicit EmptyFolders(const fs::path& folder) : before_(fs::current_path()) {
    if (const char* temporary = std::getenv("TMPDIR")) temporary_ = temporary;
    for (const char* name : {"work", "temporary"}) fs::create_directories(folder / name);
    fs::current_path(folder / "work");
    ::setenv("TMPDIR", (folder / "temporary").c_str(), 1);
  }
  EmptyFolders(const EmptyFolders&) = delete;
  EmptyFolders& operator=(const EmptyFolders&) = delete;
  ~EmptyFolders() {
    fs::current_path(before_);
    if (temporary_) {
      ::setenv("TMPDIR", temporary_->c_str(), 1);
    } else {
      ::unsetenv("TMPDIR");
    }
  }

 private:
  fs::path before_;
  std::optional<std::string> temporary_;
};

TEST(HostileFiles, OfOthersEndAsTheyShouldAndNothingIsWritten) {
  const fs::path folder = fs::weakly_canonical(hostile_files());
  if (!fs::exists(folder)) GTEST_SKIP() << "no " << folder;
  const TemporaryFolder around;
  const EmptyFolders empty(around / "");
  const auto before = listing(folder), around_before = listing(around / "");
  ASSERT_EQ(around_before.size(), 2u);
  std::set<std::string> tried;
  for (const auto& [path, time] : before) {
    if (!fs::is_regular_file(path)) continue;
    const auto file = path;
    tried.insert((file.parent_path().filename() / file.filename()).generic_string());
    within_bounds(
        64 << 20,
        [&] {
          std::string error;
          try {
            if (file.extension() == ".png") {
              Input input = Input::open(file);
              read_image(input);
            } else {
              read_scene(file);
            }
          } catch (const InputError& refused) {
            error = refused.reason();
            EXPECT_FALSE(error.empty()) << file;
            EXPECT_THAT(refused.place().file, HasSubstr(file.filename().string()));
          }
          if (expected(file).empty()) {
            EXPECT_EQ(error, "") << file;
          } else {
            EXPECT_THAT(error, HasSubstr(expected(file))) << file;
          }
        },
        file.string());
  }
  EXPECT_EQ(listing(folder), before);
  EXPECT_EQ(listing(around / ""), around_before);
  for (const auto& [name, says] : verdicts()) EXPECT_TRUE(tried.contains(name)) << "no " << name;
}

}  // namespace
}  // namespace tureen
