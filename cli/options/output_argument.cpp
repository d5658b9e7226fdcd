#include "cli/options/output_argument.hpp"

#include "base/error.hpp"
#include "base/existing_path.hpp"
#include "base/output.hpp"
#include "base/output_path.hpp"
#include "formats/diffsoup/diffsoup_export.hpp"

namespace tureen::cli {

namespace {

namespace fs = std::filesystem;

/// Throws OutputError, with `path`, unless files can be created in `folder`, which exists or is "".
void try_in(const fs::path& folder, const fs::path& path) {
  try {
    // Removes its temporary file. No file has this name, so any error comes from the folder.
    const Output probe(folder / ".tureen-probe");
  } catch (const OutputError& error) {
    throw OutputError({path.string()}, error.reason(), error.hint());
  }
}

}  // namespace

void require_not_input(const fs::path& output, const fs::path& input) {
  std::error_code error;  // reading reports missing inputs
  if (fs::equivalent(output, input, error))
    throw UsageError(output.string() + " is also an input", "choose another name");
  if (!fs::exists(output, error)) return;
  if (fs::is_directory(input, error) && lies_in(output, input))
    throw UsageError(output.string() + " exists in the folder of an input, " + input.string() +
                         "; Tureen replaces no files there",
                     "choose another folder");
  if (fs::is_directory(output, error) && lies_in(input, output))
    throw UsageError(output.string() + " contains an input, " + input.string(),
                     "choose another name");
}

void require_writable_file(const fs::path& path) { const Output probe(path); }

void require_writable_beside(const fs::path& path) { try_in(path.parent_path(), path); }

void require_writable_folder(const fs::path& folder) {
  std::error_code error;
  if (fs::is_symlink(folder, error) && !fs::exists(folder, error))
    throw OutputError({folder.string()}, "cannot become a folder: it is a broken link");
  fs::path there = folder;
  while (!there.empty() && !fs::exists(there, error) && there != there.parent_path())
    there = there.parent_path();
  if (!there.empty() && !fs::is_directory(there, error))
    throw OutputError({folder.string()},
                      "cannot become a folder: " + there.string() + " is not a folder");
  try_in(there, folder);
}

void require_writable_export(const fs::path& folder) {
  const fs::path path = folder.has_filename() ? folder : folder.parent_path();
  std::error_code error;
  if (fs::exists(path, error) && !is_diffsoup_export(path) &&
      !(fs::is_directory(path, error) && fs::is_empty(path, error)))
    throw UsageError(path.string() + " exists and is not a DiffSoup export", "choose another name");
  if (const std::string foreign = foreign_to_diffsoup_export(path); !foreign.empty())
    throw UsageError(path.string() + " would be replaced completely, but contains " + foreign +
                         ", which is not part of an export",
                     "choose another name");
  require_writable_beside(writable_folder(path));
}

}  // namespace tureen::cli
