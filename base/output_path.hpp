// Where what is written to a path goes, and what is never written over.
#pragma once

#include <filesystem>

namespace tureen {

/// `path`, or what it leads to where it is a symbolic link: also a name that is not there yet. A
/// ring of links is given back somewhere along it.
std::filesystem::path followed(const std::filesystem::path& path);

/// `followed`, for a file. Throws OutputError where a folder, a pipe or a device lies there, or a
/// file that may not be written: replacing takes a folder's permission alone, and would go past
/// that of the file; UsageError where `path` is empty. It is asked once: what is protected later
/// is replaced.
std::filesystem::path writable_file(const std::filesystem::path& path);

/// `followed`, for a folder that is replaced as a whole, whatever lies in it. Throws OutputError
/// where one lies there that may not be written.
std::filesystem::path writable_folder(const std::filesystem::path& path);

/// A name beside `path` that no other output of this process or of another has: what is written
/// there takes the name `path` when it is whole.
std::filesystem::path temporary_beside(const std::filesystem::path& path);

}  // namespace tureen
