// Checks that the outputs named on the command line can be written. The checks run before anything
// is read or measured, which may take hours.
#pragma once

#include <filesystem>

namespace tureen::cli {

/// Throws UsageError if writing `output`, a file or a complete folder, could replace an input. That
/// is the case if both paths lead to the same file or folder, if `output` exists in the folder
/// `input`, or if `output` is a folder that contains `input`.
void require_not_input(const std::filesystem::path& output, const std::filesystem::path& input);

/// Throws OutputError unless a file can be written there (base/output_path.hpp). Creates and
/// removes a temporary file beside it.
void require_writable_file(const std::filesystem::path& path);

/// The same for files or folders beside `path`; ignores what exists at `path` itself.
void require_writable_beside(const std::filesystem::path& path);

/// The same for files in `folder`. The folder and its parents need not exist yet.
void require_writable_folder(const std::filesystem::path& folder);

/// The same for a DiffSoup export. Throws UsageError if another folder or file exists there.
void require_writable_export(const std::filesystem::path& folder);

}  // namespace tureen::cli
