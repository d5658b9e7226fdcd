// Small functions of the operating system that the standard library lacks.
#pragma once

#include <cstdio>
#include <filesystem>

namespace tureen {

/// Whether the effective user may write to an existing file or folder.
bool may_write(const std::filesystem::path& path);

/// Swaps two existing names atomically. Returns false and changes nothing if the system cannot.
bool swap_names(const std::filesystem::path& a, const std::filesystem::path& b);

/// The number of this process.
int process_id();

/// Whether there is a process of this number. True if the system cannot say.
bool is_process(int number);

/// Whether the stream is a terminal.
bool is_terminal(std::FILE* stream);

}  // namespace tureen
