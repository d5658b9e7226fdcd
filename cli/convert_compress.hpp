// `tureen convert --compress`: its options, its output and its messages.
#pragma once

#include <filesystem>

#include "cli/options/arguments.hpp"
#include "cli/options/dataset_argument.hpp"
#include "cli/report.hpp"
#include "scene/scene.hpp"

namespace tureen::cli {

struct CompressArguments {
  bool compressed = false;
  bool keep_cameras = false;
  bool keep_unseen = false;
  double max_error_db = 0.1;
  DatasetArgument photographs;  // no path: none
};

/// --compress (also --slim), --max-error, --photographs, --scale, --keep-unseen and --keep-cameras.
/// `arguments` must live until the arguments are parsed.
void add_compressed_arguments(Command& command, CompressArguments& arguments);

/// Checks the options before the scene is read. Throws UsageError.
void check_compressed(const CompressArguments& arguments, const std::filesystem::path& output);

/// Writes the compressed file `glb`. Prints all losses and the size, and returns both as JSON.
/// Throws Interrupted, and the exceptions of compress() and write_compressed_glb().
Json convert_compressed(Scene scene, const CompressArguments& arguments,
                        const std::filesystem::path& glb);

}  // namespace tureen::cli
