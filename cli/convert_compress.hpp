// `tureen convert --compress`: its options, its output and its messages.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

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

/// Throws UsageError for what can be known to be wrong before the scene is read.
void check_compressed(const CompressArguments& arguments, const std::filesystem::path& output);

/// Writes the compressed file `glb`; says in full what was lost, and how small it is beside the
/// published export of the same soup. Returns the same as JSON. Throws what compress() and
/// write_compressed_glb() throw, and Interrupted.
Json convert_compressed(Scene scene, const CompressArguments& arguments,
                        const std::filesystem::path& glb);

}  // namespace tureen::cli
