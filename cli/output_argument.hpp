// Outputs named on the command line: whether they can be written is found out before anything is
// read or measured, which may take hours.
#pragma once

#include <filesystem>

namespace tureen::cli {

/// Throws UsageError where both are the same file, by whatever names, or where `input` is a folder
/// and `output` a file that is there already, in it: what was read would be lost.
void require_not_input(const std::filesystem::path& output, const std::filesystem::path& input);

/// Throws OutputError unless a file can be written there (formats/output_path.hpp). Tries it: a
/// temporary file beside it, which goes again.
void require_writable_file(const std::filesystem::path& path);

/// The same of files or folders beside `path`, whatever lies there itself.
void require_writable_beside(const std::filesystem::path& path);

/// The same of files in `folder`, which need not be there yet, nor those above it.
void require_writable_folder(const std::filesystem::path& folder);

/// The same of a DiffSoup export. Throws UsageError where a folder or file other than one is there.
void require_writable_export(const std::filesystem::path& folder);

}  // namespace tureen::cli
