// The destination of an output path, and the checks that protect existing files.
#pragma once

#include <filesystem>

namespace tureen {

/// `path` with symbolic links followed, also to a name that does not exist yet. For a cycle of
/// links the result is some path on the cycle.
std::filesystem::path followed(const std::filesystem::path& path);

/// `followed`, for a file. Throws OutputError if a folder, a pipe or a device exists there. Throws
/// OutputError too if the existing file is read-only: a rename needs only the folder's permission
/// and would bypass that of the file. Throws UsageError if `path` is empty. The check runs once: a
/// file protected later is replaced.
std::filesystem::path writable_file(const std::filesystem::path& path);

/// `followed`, for a folder that is replaced with all its contents. Throws OutputError if the
/// existing folder is not writable.
std::filesystem::path writable_folder(const std::filesystem::path& path);

/// A unique name beside `path`, also across processes. The complete output is renamed from it to
/// `path`. If there is a file or folder at `path`, removes what killed processes left under its
/// temporary names more than an hour ago: those that were there when this process first wrote to
/// the folder.
std::filesystem::path temporary_beside(const std::filesystem::path& path);

}  // namespace tureen
