#include "bench/page/measurements.hpp"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <utility>

#include "soup/error.hpp"

namespace tureen::test {

namespace {

namespace fs = std::filesystem;

std::string contents(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw InputError({path.string(), {}, {}}, "it cannot be read");
  return {std::istreambuf_iterator<char>(file), {}};
}

Json parsed(const fs::path& path) {
  Json json = Json::parse(contents(path), nullptr, false);
  if (json.is_discarded()) throw InputError({path.string(), {}, {}}, "it is no JSON");
  return json;
}

}  // namespace

Measurements::Measurements(fs::path folder, std::vector<std::string> names)
    : folder_(std::move(folder)), names_(std::move(names)) {
  std::sort(names_.begin(), names_.end());
}

std::vector<std::string> Measurements::beginning_with(const std::string& prefix) const {
  std::vector<std::string> result;
  std::copy_if(names_.begin(), names_.end(), std::back_inserter(result),
               [&](const std::string& name) { return name.starts_with(prefix); });
  return result;
}

Measurements::Run Measurements::run(const std::string& name) const {
  const Json json = parsed(folder_ / (name + ".run.json"));
  return {.command = json.at("command"),
          .date = json.at("date"),
          .commit = json.at("commit"),
          .cpu = json.at("cpu"),
          .cores = json.at("cores")};
}

std::string Measurements::text(const std::string& name) const {
  return contents(folder_ / (name + ".txt"));
}

Json Measurements::printed(const std::string& name) const {
  return parsed(folder_ / (name + ".txt"));
}

fs::path Measurements::file(const std::string& name, const std::string& path) const {
  return folder_ / name / path;
}

std::string Measurements::text_of(const std::string& name, const std::string& path) const {
  return contents(file(name, path));
}

Json Measurements::json(const std::string& name, const std::string& path) const {
  return parsed(file(name, path));
}

}  // namespace tureen::test
