// One or several scenes named on the command line, read with progress.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "cli/options/arguments.hpp"
#include "formats/scene_file.hpp"

namespace tureen::cli {

/// What the command line changes of a scene as it is read.
struct ReadingChoice {
  VertexColorSpace vertex_colors = VertexColorSpace::automatic;
  std::string up;            // empty: the scene's own; of several scenes, the first's
  std::string_view profile;  // of named_profiles, for all splats; empty: the scene's own
  std::optional<double> near_limit = {};         // of all splats, in world units
  std::optional<double> octagon_q = {};          // ReadOptions::octagon_q
  std::optional<std::uint64_t> max_splats = {};  // ReadOptions::max_splats
  std::optional<std::size_t> lod = {};           // ReadOptions::lod
  bool keep_rows = false;                        // ReadOptions::keep_rows; not an option
  std::vector<std::string> places = {};          // of layers (scene/document/place_text.hpp)
  UpAxes up_axes = UpAxes::turn;                 // of several scenes

  bool operator==(const ReadingChoice&) const = default;
};

/// Adds --vertex-colors, --up, --octagon-q, --profile, --near-limit, --lod and --max-splats.
/// `choice` must live until the arguments are parsed.
void add_reading_options(Command& command, ReadingChoice& choice);

/// Adds --place and --keep-axes, for commands that read SceneArguments.
void add_placing_options(Command& command, ReadingChoice& choice);

struct SceneArgument {
  std::string path;
  ReadingChoice choice = {};
};

/// Adds the required argument SCENE, and the options of add_reading_options().
void add_scene_argument(Command& command, SceneArgument& argument);

/// Several scenes, combined into one, each as a layer. The options apply to each of them.
struct SceneArguments {
  std::vector<std::string> paths;  // at least one
  ReadingChoice choice = {};
};

/// Adds the required list of arguments SCENE, and the options of add_reading_options().
void add_scene_arguments(Command& command, SceneArguments& arguments);

/// Throws InputError, with a suggestion if the path does not exist; UsageError for a choice that
/// does not fit the scene.
Scene read(const SceneArgument& argument);

/// The same for a command that supports only one layer at an origin: applies the layer's rotation,
/// scale or mirror to the vertices (scene/edit/baked_transform.hpp). Throws UsageError for several
/// layers, and for a transform that would change colours.
Scene read_one_layer(const SceneArgument& argument);

/// The same as read() for all scenes, merged (scene/scene.hpp). If there are several, a scene
/// without a name gets the name of its file. Throws UsageError for more than max_layers layers.
Scene read(const SceneArguments& arguments);

/// require_not_input() for each scene (cli/options/output_argument.hpp).
void require_not_inputs(const std::filesystem::path& output, const SceneArguments& arguments);

/// Prints a sentence if no layer is visible, and one for each layer of only transparent splats.
void say_what_is_hidden(const Scene& scene);

/// "a.glb", "a.glb, b.glb".
std::string listed(const SceneArguments& arguments);

/// Size in bytes of a file, or of all files in a folder; files that cannot be read count as 0.
std::uint64_t bytes_on_disk(const std::filesystem::path& path);
/// The sum over all scenes.
std::uint64_t bytes_on_disk(const SceneArguments& arguments);

}  // namespace tureen::cli
