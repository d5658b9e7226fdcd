// `tureen convert`: a scene in another format.
#include <filesystem>
#include <memory>

#include "cli/commands.hpp"
#include "cli/convert_slim.hpp"
#include "cli/report.hpp"
#include "cli/scene_argument.hpp"
#include "soup/error.hpp"

namespace tureen::cli {

namespace {

struct Options {
  SceneArgument scene;
  std::string output;
  bool force = false;
  bool json = false;
  SlimArguments slim;
};

ExitCode convert_scene(const Options& options) {
  const std::filesystem::path output = options.output;
  std::error_code error;
  // Before the scene is read, which may take a while.
  if (std::filesystem::exists(output, error)) {
    if (std::filesystem::equivalent(output, options.scene.path, error))
      throw UsageError(options.output + " is the scene itself; choose another name");
    if (!options.force) throw UsageError(options.output + " exists already; --force replaces it");
  }
  check_slim(options.slim, output);
  Scene scene = read(options.scene);
  if (options.slim.slim) {
    say_list("Reading " + options.scene.path + ":", scene.info.notes);
    const Json json = convert_slim(std::move(scene), options.slim, output);
    if (options.json) print_json(json);
    return ExitCode::done;
  }
  const std::vector<std::string> lost = write_scene(scene, output);
  const std::uint64_t bytes = bytes_on_disk(output);
  say_list("Reading " + options.scene.path + ":", scene.info.notes);
  say_list("Lost in " + options.output + ":", lost);
  say("wrote " + options.output + ", " + bytes_text(bytes));
  if (options.json)
    print_json({{"output", options.output},
                {"bytes_on_disk", bytes},
                {"notes", scene.info.notes},
                {"lost", lost}});
  return ExitCode::done;
}

/// "  .glb         glTF: .." of every format that can be written.
std::string written_formats() {
  std::string text;
  for (const FormatInfo& format : known_formats()) {
    if (!format.can_write) continue;
    std::string extensions;
    for (const std::string& extension : format.extensions)
      extensions += (extensions.empty() ? "" : ", ") + extension;
    if (extensions.empty()) extensions = "(folder)";
    extensions.resize(std::max<std::size_t>(extensions.size() + 1, 16), ' ');
    text += "  " + extensions + format.name + ": " + format.description + "\n";
  }
  return text;
}

}  // namespace

void add_convert(CLI::App& program, Action& action) {
  auto options = std::make_shared<Options>();
  CLI::App* command = program.add_subcommand("convert", "A scene in another format");
  command->footer("The extension of OUT says which format is written:\n" + written_formats() +
                  R"(What the format cannot hold is left out and said.

Examples:
  tureen convert trained.pt soup.glb          to the file that we deploy
  tureen convert soup.glb soup.off --force    replaces soup.off
  tureen convert soup.glb small.glb --slim --photographs lego --scale 0.5
                                              loses 0.1 dB against lego, no more
  tureen convert foreign.glb soup.glb --vertex-colors srgb --up 0,0,1)");
  add_scene_argument(*command, options->scene, "IN");
  command->add_option("OUT", options->output, "the file (or folder) to write")
      ->required()
      ->type_name("");
  command->add_flag("--force", options->force, "replace OUT if it exists");
  command->add_flag("--json", options->json,
                    "what was written and lost as JSON on standard output");
  add_slim_arguments(*command, options->slim);
  command->callback([options, &action] { action = [options] { return convert_scene(*options); }; });
}

}  // namespace tureen::cli
