// Puts what `./dev bench` measured into the pages of docs/: each section between the two marks that
// bear its name, wherever a page has them; everything else stays as people wrote it.
//
//   bench_report MEASURED DOCS NAME..
//
// MEASURED is the folder that reproduce.sh writes, NAME what it has just measured; plots go into
// DOCS/images.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "bench/page/sections.hpp"
#include "soup/error.hpp"
#include "support/measured.hpp"

namespace tureen::test {

namespace {

namespace fs = std::filesystem;

bool holds(const fs::path& page, const std::string& text) {
  std::ifstream file(page, std::ios::binary);
  const std::string whole((std::istreambuf_iterator<char>(file)), {});
  return whole.find(text) != std::string::npos;
}

std::vector<fs::path> pages_in(const fs::path& docs) {
  std::vector<fs::path> pages;
  for (const auto& entry : fs::directory_iterator(docs))
    if (entry.path().extension() == ".md") pages.push_back(entry.path());
  std::sort(pages.begin(), pages.end());
  return pages;
}

/// Into every page that has a place for it; says where, or that there is none.
void write_section(const Section& section, const std::vector<fs::path>& pages,
                   const fs::path& images) {
  const Marks marks("./dev bench, " + section.name);
  bool has_place = false;
  for (const fs::path& page : pages) {
    if (!holds(page, marks.begin)) continue;
    has_place = true;
    write_between(page, marks, "\n" + section.text);
    std::fprintf(stderr, "%s: %s\n", page.string().c_str(), section.name.c_str());
  }
  if (!has_place) {
    std::fprintf(stderr, "no page has a place for %s\n", section.name.c_str());
    return;
  }
  for (const Section::Plot& plot : section.plots)
    fs::copy_file(plot.from, images / plot.name, fs::copy_options::overwrite_existing);
}

}  // namespace

}  // namespace tureen::test

int main(int argc, char** argv) {
  using namespace tureen::test;
  if (argc < 4) {
    std::fprintf(stderr, "usage: bench_report MEASURED DOCS NAME..\n");
    return 2;
  }
  try {
    const std::filesystem::path docs = argv[2];
    const auto pages = pages_in(docs);
    std::filesystem::create_directories(docs / "images");
    Sections sections = sections_of(Measurements(argv[1], {argv + 3, argv + argc}));
    for (const Section& section : sections.made) try {
        write_section(section, pages, docs / "images");
      } catch (const std::exception& error) {
        sections.failures.push_back(section.name + ": " + error.what());
      }
    for (const std::string& failure : sections.failures)
      std::fprintf(stderr, "bench_report: %s\n", failure.c_str());
    if (!sections.failures.empty()) return 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_report: %s\n", error.what());
    return 1;
  }
}
