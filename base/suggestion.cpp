#include "base/suggestion.hpp"

#include <algorithm>
#include <vector>

namespace tureen {

namespace {

std::filesystem::path folder_of(const std::filesystem::path& path) {
  return path.has_parent_path() ? path.parent_path() : ".";
}

/// ASCII letters in lower case; other bytes, as of UTF-8, stay.
std::string lower_case(std::string text) {
  for (char& letter : text)
    if (letter >= 'A' && letter <= 'Z') letter = char(letter - 'A' + 'a');
  return text;
}

}  // namespace

int edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::vector<int>> distance(a.size() + 1, std::vector<int>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) distance[i][0] = int(i);
  for (std::size_t j = 0; j <= b.size(); ++j) distance[0][j] = int(j);
  for (std::size_t i = 1; i <= a.size(); ++i)
    for (std::size_t j = 1; j <= b.size(); ++j) {
      int best = std::min(distance[i - 1][j] + 1, distance[i][j - 1] + 1);
      best = std::min(best, distance[i - 1][j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1));
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        best = std::min(best, distance[i - 2][j - 2] + 1);
      distance[i][j] = best;
    }
  return distance[a.size()][b.size()];
}

std::string nearest(const std::string& word, std::span<const std::string> known) {
  const std::string low = lower_case(word);
  std::string best;
  // One error is allowed even in words below three letters.
  int best_distance = std::max(1, int(word.size()) / 3) + 1;
  for (const std::string& candidate : known) {
    const int distance = edit_distance(low, lower_case(candidate));
    // Of names that differ in case alone, the one with more letters in the same case.
    if (distance < best_distance || (distance == best_distance && !best.empty() &&
                                     edit_distance(word, candidate) < edit_distance(word, best))) {
      best = candidate;
      best_distance = distance;
    }
  }
  if (!best.empty() || word.empty()) return best;
  for (const std::string& candidate : known)
    if (lower_case(candidate).compare(0, low.size(), low) == 0) return candidate;
  return "";
}

std::string did_you_mean(const std::string& word, std::span<const std::string> known) {
  const std::string near = nearest(word, known);
  return near.empty() ? "" : "did you mean " + near + "?";
}

std::string did_you_mean(const std::filesystem::path& path) {
  // Only this many names are searched, since the message must not take seconds.
  constexpr std::size_t max_names = 10000;
  std::vector<std::string> names;
  std::error_code error;
  for (std::filesystem::directory_iterator it(folder_of(path), error), end;
       !error && it != end && names.size() < max_names; it.increment(error))
    names.push_back(it->path().filename().string());
  std::sort(names.begin(), names.end());  // a directory_iterator has no fixed order
  const std::string near = nearest(path.filename().string(), names);
  return near.empty() ? "" : "did you mean " + (path.parent_path() / near).string() + "?";
}

std::string why_missing(const std::filesystem::path& path) {
  const std::filesystem::path folder = folder_of(path);
  std::error_code error;
  return std::filesystem::is_directory(folder, error) ? "there is no such file or folder"
                                                      : "there is no folder " + folder.string();
}

}  // namespace tureen
