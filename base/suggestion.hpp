// Suggestions ("did you mean ..?") for names in files and on command lines.
#pragma once

#include <filesystem>
#include <span>
#include <string>

namespace tureen {

/// The number of insertions, deletions, substitutions and swaps of neighbours from a to b (optimal
/// string alignment distance).
int edit_distance(const std::string& a, const std::string& b);

/// The nearest of `known`, without regard to the case of ASCII letters. If more than a third of the
/// letters are wrong, the first that begins with the word, or else "".
std::string nearest(const std::string& word, std::span<const std::string> known);

/// "did you mean NAME?" with the nearest of `known`, or "". For the hint of an error.
std::string did_you_mean(const std::string& word, std::span<const std::string> known);

/// The same for a path that does not exist, with the names in its folder as candidates.
std::string did_you_mean(const std::filesystem::path& path);

/// The reason for an error about a path that does not exist: it, or its folder, is missing.
std::string why_missing(const std::filesystem::path& path);

}  // namespace tureen
