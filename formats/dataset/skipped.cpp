#include "formats/dataset/skipped.hpp"

#include <algorithm>

#include "base/error.hpp"
#include "formats/dataset/dataset_remarks.hpp"

namespace tureen {

namespace {

/// The first names, and how many more there are.
std::vector<std::string> first_names(const std::vector<std::string>& names) {
  constexpr std::size_t most = 12;
  if (names.size() <= most) return names;
  std::vector<std::string> first(names.begin(), names.begin() + most);
  first.push_back("and " + std::to_string(names.size() - most) + " more");
  return first;
}

}  // namespace

void SkippedPhotographs::add(const std::string& name, const std::string& reason) {
  ++count_;
  const auto known = std::find_if(names_.begin(), names_.end(),
                                  [&](const auto& entry) { return entry.first == reason; });
  if (known == names_.end())
    names_.push_back({reason, {name}});
  else
    known->second.push_back(name);
}

std::string SkippedPhotographs::sentences() const {
  constexpr std::size_t most = 3;
  std::string text;
  for (std::size_t i = 0; i < names_.size(); ++i) {
    if (i == most && names_.size() > most + 1)
      return text + "; and " + std::to_string(names_.size() - most) + " other reasons";
    const auto& [reason, names] = names_[i];
    text += (text.empty() ? "" : "; ");
    std::string list;
    for (const std::string& name : first_names(names)) list += (list.empty() ? "" : ", ") + name;
    text += list + ": " + reason;
  }
  return text;
}

void SkippedPhotographs::require_enough(const std::string& file, std::size_t left,
                                        bool is_strict) const {
  if (count_ == 0 || (!is_strict && left >= 3 && left >= count_)) return;
  throw InputError({file},
                   std::to_string(count_) + " of " + std::to_string(count_ + left) +
                       " photographs cannot be used: " + sentences(),
                   is_strict
                       ? "omit --strict to skip them"
                       : "at least three photographs, and at least half of them, must be usable");
}

void SkippedPhotographs::add_remarks(std::vector<Remark>& list, std::size_t left) const {
  for (const auto& [reason, names] : names_)
    list.push_back({&remarks::photographs_skipped,
                    {{"count", std::uint64_t(names.size())},
                     {"all", std::uint64_t(count_ + left)},
                     {"names", first_names(names)},
                     {"reason", reason}}});
}

}  // namespace tureen
