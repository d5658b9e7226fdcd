#include "formats/dataset/dataset_split.hpp"

#include <algorithm>
#include <filesystem>
#include <set>

#include "formats/dataset/dataset_remarks.hpp"

namespace tureen {

namespace {

/// Names differ in "./" and in the suffix, which some lists omit.
std::string plain(std::string name) {
  std::replace(name.begin(), name.end(), '\\', '/');
  return std::filesystem::path(name).lexically_normal().replace_extension().string();
}

std::set<std::string> plain_names(const std::vector<std::string>& names) {
  std::set<std::string> result;
  for (const std::string& name : names) result.insert(plain(name));
  return result;
}

/// Whether the name, or its file without folders, is listed.
bool is_listed(const std::set<std::string>& names, const DatasetFrame& frame) {
  const std::string name = plain(frame.name);
  return names.contains(name) || names.contains(std::filesystem::path(name).filename().string());
}

/// A remark on names of the lists that fit no photograph.
void add_remark_on_unknown(const NamedSplit& named, const Frames& frames,
                           std::vector<Remark>& list) {
  std::set<std::string> known;
  for (const DatasetFrame& frame : frames) {
    known.insert(plain(frame.name));
    known.insert(std::filesystem::path(plain(frame.name)).filename().string());
  }
  std::set<std::string> unknown;
  for (const auto* names : {&named.train, &named.validation, &named.test})
    for (const std::string& name : *names)
      if (!known.contains(plain(name))) unknown.insert(name);
  if (unknown.empty()) return;
  constexpr std::size_t most = 5;
  std::vector<std::string> shown(
      unknown.begin(), std::next(unknown.begin(), std::ptrdiff_t(std::min(most, unknown.size()))));
  if (unknown.size() > most) shown.push_back("others");
  list.push_back({&remarks::split_names_unknown,
                  {{"source", named.source},
                   {"count", std::uint64_t(unknown.size())},
                   {"names", std::move(shown)}}});
}

}  // namespace

void sort_by_name(Frames& frames) {
  std::stable_sort(frames.begin(), frames.end(),
                   [](const DatasetFrame& a, const DatasetFrame& b) { return a.name < b.name; });
}

SplitFrames split(Frames all, const NamedSplit& named, int test_every, bool needs_test) {
  sort_by_name(all);
  SplitFrames result;
  add_remark_on_unknown(named, all, result.remarks);
  const std::set<std::string> train = plain_names(named.train);
  const std::set<std::string> test =
      plain_names(named.test.empty() ? named.validation : named.test);
  std::vector<std::string> unused;
  for (DatasetFrame& frame : all) {
    if (is_listed(test, frame))
      result.test.push_back(frame);
    else if (train.empty() || is_listed(train, frame))
      result.train.push_back(frame);
    else
      unused.push_back(frame.name);
  }
  const bool has_lists = !train.empty() || !test.empty();
  if (has_lists && !result.train.empty() && !result.test.empty()) {
    result.remarks.push_back({&remarks::split_named,
                              {{"source", named.source},
                               {"train", std::uint64_t(result.train.size())},
                               {"test", std::uint64_t(result.test.size())},
                               {"unused", std::uint64_t(unused.size())}}});
    return result;
  }
  // A list of training views alone leaves the others to test.
  if (has_lists && test.empty() && !unused.empty()) {
    std::erase_if(all, [&](const DatasetFrame& frame) { return is_listed(train, frame); });
    result.test = std::move(all);
    result.remarks.push_back({&remarks::split_named,
                              {{"source", named.source},
                               {"train", std::uint64_t(result.train.size())},
                               {"test", std::uint64_t(result.test.size())},
                               {"unused", std::uint64_t(0)}}});
    return result;
  }
  result.train.clear();
  result.test.clear();
  if (has_lists) result.remarks.push_back({&remarks::split_empty, {{"source", named.source}}});
  if (all.size() == 1 && !needs_test) {
    result.train = std::move(all);
    return result;
  }
  for (std::size_t i = 0; i < all.size(); ++i)
    (i % std::size_t(test_every) == 0 ? result.test : result.train).push_back(std::move(all[i]));
  return result;
}

}  // namespace tureen
