// Hostile files by others: PngSuite, the glTF validator, tinygltf and Magnum, if their folder lies
// beside the repository. Each gives the expected result, and nothing is written.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>

#include "formats/scene_file.hpp"
#include "image/png.hpp"
#include "tests/formats/format_testing.hpp"
#include "tests/formats/hostile_bounds.hpp"

namespace tureen {
namespace hostile_files_test {

using test::error_of;
using test::ErrorIn;
namespace fs = std::filesystem;
using test::TemporaryFolder;
using test::within_bounds;

/// The folder of hostile files beside the repository, if it exists.
fs::path hostile_files() { return TUREEN_SOURCE_DIR "/../shared/data/hostile"; }

std::map<fs::path, fs::file_time_type> listing(const fs::path& folder) {
  std::map<fs::path, fs::file_time_type> result;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    result[entry.path()] = entry.is_directory() ? fs::file_time_type() : entry.last_write_time();
  return result;
}

/// Exceptions to the rules of `expected`, by folder and name. The value is a text in the error (""
/// for any error), or empty if the file is readable.
const std::map<std::string, std::optional<std::string>>& verdicts() {
  static const std::map<std::string, std::optional<std::string>> of_files{
      {"BoundsChecking/invalid-primitive-indices.gltf", ""},
      {"Cube-texture-ext/Cube-textransform.gltf", ""},
      {"CubeImageUriSpaces/CubeImageUriSpaces.gltf", ""},
      {"Test/colors-not-same-type.ply", ""},
      {"Test/colors-not-tightly-packed.ply", ""},
      {"Test/colors4-not-tightly-packed.ply", ""},
      {"Test/empty-le.ply", ""},
      {"Test/empty.ply", ""},
      {"Test/extra-token-face-element.ply", "extradata"},
      {"Test/extra-token-face-property.ply", "extradata"},
      {"Test/extra-token-vertex-element.ply", "extradata"},
      {"Test/extra-token-vertex-property.ply", "extradata"},
      {"Test/format-missing.ply", "format"},
      {"Test/format-unsupported.ply", "binary_mixed_endian"},
      {"Test/integer-literal-too-large.ply", "vertex"},
      {"Test/invalid-face-property.ply", "extradata"},
      {"Test/invalid-face-type.ply", "float16"},
      {"Test/invalid-vertex-property.ply", "extradata"},
      {"Test/normals-unsupported-type.ply", ""},
      {"Test/positions-missing.ply", "vertex"},
      {"Test/positions-not-all.ply", "vertex"},
      {"Test/texcoords-not-all.ply", ""},
      {"Test/texcoords-not-tightly-packed.ply", ""},
      {"accessor/unknown_type.gltf", "NotaVEC3"},
      {"asset/min_version_invalid.gltf", "2.1"},
      {"buffer_view/empty_object.gltf", "buffer"},
      {"buffer_view/invalid_stride_multiple.gltf", "4"},
      {"camera/empty_objects.gltf", "type"},
      {"glb/invalid_version.glb", "0"},
      {"glb/length_mismatch.glb", "49"},
      {"glb/misplaced_bin_chunk.glb", ""},
      {"glb/no_header.glb", "glTF"},
      {"glb/only_bin_chunk.glb", ""},
      {"glb/truncated_chunk_header.glb", "4"},
      {"glb/two_bin_chunks.glb", ""},
      {"glb/zero_length.glb", "0"},
      {"json/empty_file.gltf", ""},
      {"json/invalid_syntax.gltf", "glTF"},
      {"mesh/empty_object.gltf", "meshes[1].primitives"},
      {"mesh/unresolved_indices.gltf", ""},
      {"models/box01.glb", {}},
      {"node/node_skinned_mesh_without_skin.gltf", {}},
      {"node/node_weights_invalid.gltf", {}},
      {"node/node_weights_override.gltf", {}},
      {"node/unresolved_camera.gltf", "nodes[0]"},
      {"node/unresolved_child_node.gltf", "1"},
      {"off/empty.off", ""},
      {"off/invalid.off", ""},
      {"png/xcsn0g01.png", ""},
      {"png/xdtn0g01.png", "IDAT"},
      {"png/xhdn0g08.png", ""},
      {"regression/zero-sized-bin-chunk-issue-440.glb", {}},
      {"root/empty_object.gltf", "glTF"},
      {"root/invalid_collection_type.gltf", ""},
      {"scene/unresolved_child_node.gltf", "5"},
      {"scene/unresolved_default_scene.gltf", "0"},
      {"skin/ignored_local_transform.gltf", {}},
      {"skin/ignored_parent_transform.gltf", {}},
      {"skin/no_joints_in_scene.gltf", {}},
  };
  return of_files;
}

/// The expected result for a file: a text in its error, or empty if it is readable.
std::optional<std::string> expected(const fs::path& file) {
  const auto found =
      verdicts().find((file.parent_path().filename() / file.filename()).generic_string());
  if (found != verdicts().end()) return found->second;
  const std::string extension = file.extension().string();
  // In PngSuite, the files whose names begin with x are broken.
  if (extension == ".png" && file.filename().string()[0] != 'x') return std::nullopt;
  // Most files of the validator have no mesh: their errors are elsewhere. Others are buffers or
  // licences.
  if (extension == ".png" || extension == ".gltf" || extension == ".glb" || extension == ".bin" ||
      extension == ".txt")
    return "";
  return std::nullopt;
}

/// While it exists, the working folder and the temporary folder are empty folders.
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
          const auto error = error_of([&] {
            if (file.extension() == ".png") {
              Input input = Input::open(file);
              read_image(input);
            } else {
              read_scene(file);
            }
          });
          if (const auto verdict = expected(file)) {
            EXPECT_THAT(error, ErrorIn(file.filename().string(), *verdict)) << file;
          } else {
            EXPECT_EQ(error, std::nullopt) << file;
          }
        },
        file.string());
  }
  EXPECT_EQ(listing(folder), before);
  EXPECT_EQ(listing(around / ""), around_before);
  for (const auto& [name, verdict] : verdicts()) EXPECT_TRUE(tried.contains(name)) << "no " << name;
}

}  // namespace hostile_files_test
}  // namespace tureen
