// Outputs named on the command line: whether they can be written is found out before anything is
// read or measured, which may take hours.
#pragma once

#include <filesystem>

namespace tureen::cli {

/// Throws UsageError where writing `output`, a file or a folder as a whole, could take the place of
/// what is read: where both are the same, by whatever names; where `output` is there already in the
/// folder `input`, whether it is read or not; and where it is a folder that holds `input`.
void require_not_input(const std::filesystem::path& output, const std::filesystem::path& input);

/// Throws OutputError unless a file can be written there (base/output_path.hpp). Tries it: a
/// temporary file beside it, which goes again.
void require_writable_file(const std::filesystem::path& path);

/// The same of files or folders beside `path`, whatever lies there itself.
void require_writable_beside(const std::filesystem::path& path);

/// The same of files in `folder`, which need not be there yet, nor those above it.
void require_writable_folder(const std::filesystem::path& folder);

/// The same of a DiffSoup export. Throws UsageError where a folder or file other than one is there.
void require_writable_export(const std::filesystem::path& folder);

}  // namespace tureen::cli
