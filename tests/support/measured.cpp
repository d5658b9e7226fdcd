#include "support/measured.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iterator>

#include "formats/output.hpp"
#include "soup/error.hpp"

namespace tureen::test {

namespace fs = std::filesystem;

void leave_measured(const std::string& name, const nlohmann::json& measured) {
  const char* folder = std::getenv("TUREEN_MEASURED");
  if (!folder) return;
  fs::create_directories(folder);
  std::ofstream file(fs::path(folder) / (name + ".json"));
  file << measured.dump(1) << "\n";
  file.close();
  EXPECT_TRUE(file) << folder << ": " << name << " cannot be written";
}

std::vector<Measured> read_measured(const fs::path& folder) {
  std::vector<Measured> result;
  if (fs::is_directory(folder))
    for (const auto& entry : fs::directory_iterator(folder)) {
      if (entry.path().extension() != ".json") continue;
      std::ifstream file(entry.path());
      nlohmann::json json = nlohmann::json::parse(file, nullptr, false);
      if (json.is_discarded()) throw InputError({entry.path().string(), {}, {}}, "it is no JSON");
      result.push_back({entry.path().stem().string(), std::move(json)});
    }
  if (result.empty())
    throw InputError({folder.string(), {}, {}}, "no test has written anything there");
  std::sort(result.begin(), result.end(),
            [](const Measured& a, const Measured& b) { return a.name < b.name; });
  return result;
}

Marks::Marks(const std::string& command)
    : begin("<!-- measured: written by " + command + " -->\n"),
      end("<!-- end of what is measured -->\n") {}

void write_between(const fs::path& page, const Marks& marks, const std::string& text) {
  std::ifstream file(page, std::ios::binary);
  std::string whole((std::istreambuf_iterator<char>(file)), {});
  const std::size_t begin = whole.find(marks.begin);
  const std::size_t end = begin == std::string::npos ? begin : whole.find(marks.end, begin);
  if (end == std::string::npos)
    throw InputError(
        {page.string(), {}, {}},
        "the page has no place for what is measured, between the lines " + marks.begin + marks.end);
  const std::size_t after = begin + marks.begin.size();
  // An end that is missing: the next one is another section's, and what people wrote lies before
  // it.
  if (const std::size_t next = whole.find("<!-- measured:", after); next < end)
    throw InputError({page.string(), {}, {}},
                     "what " + marks.begin + "begins has no end before the next begins");
  whole.replace(after, end - after, text);
  Output output(page);
  output.write(whole);
  output.commit();
}

std::string table_cell(std::string text) {
  for (std::size_t at = 0; (at = text.find('|', at)) != std::string::npos; at += 2)
    text.insert(at, 1, '\\');
  return text;
}

}  // namespace tureen::test
