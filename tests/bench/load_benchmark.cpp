// How long a large soup takes to load, and how much memory: makes it out of a small scene, writes
// it in every format asked for, and reads each in a process of its own, on one thread. The files
// have just been written, so they come from the page cache: this measures us, not the disk.
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "bench/dense_soup.hpp"
#include "formats/scene_file.hpp"

namespace {

using namespace tureen;
using nlohmann::json;
namespace fs = std::filesystem;

/// ru_maxrss counts in KiB on Linux and in bytes on macOS.
std::uint64_t peak_resident_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
#ifdef __APPLE__
  return std::uint64_t(usage.ru_maxrss);
#else
  return std::uint64_t(usage.ru_maxrss) * 1024;
#endif
}

/// Processor time of this process, user and system.
double cpu_seconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& t) { return double(t.tv_sec) + 1e-6 * double(t.tv_usec); };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

/// Runs in a child: makes the soup and writes it under every extension.
json make(const fs::path& base, const fs::path& folder, const std::vector<std::string>& extensions,
          std::size_t triangles) {
  Scene small = read_scene(base);
  Scene scene;
  scene.info = small.info;
  scene.info.notes.clear();
  scene.primitives = testing::dense_soup(opaque_soup(small), triangles);
  json report = json::object();
  report["fingerprint"] = testing::fingerprint(std::get<TriangleSoup>(scene.primitives));
  fs::create_directories(folder);
  for (const std::string& extension : extensions) {
    const auto start = std::chrono::steady_clock::now();
    write_scene(scene, folder / ("dense" + extension));
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    report["write_seconds"][extension] = seconds.count();
  }
  return report;
}

/// Runs in a child: reads one file and says what that took.
json load(const fs::path& path) {
  const std::uint64_t before = peak_resident_bytes();
  const double cpu_before = cpu_seconds();
  const auto start = std::chrono::steady_clock::now();
  const Scene scene = read_scene(path);
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  const double cpu = cpu_seconds() - cpu_before;
  const std::uint64_t peak = peak_resident_bytes();
  const auto& soup = std::get<TriangleSoup>(scene.primitives);
  return {{"seconds", seconds.count()},
          {"cpu_seconds", cpu},
          {"peak_bytes", peak},
          {"idle_bytes", before},
          {"soup_bytes", byte_size(soup)},
          {"ratio", double(peak) / double(byte_size(soup))},
          {"triangles", soup.triangles.size()},
          {"fingerprint", testing::fingerprint(soup)}};
}

/// This program again with other arguments. A fresh process and not a mere fork: the peak of a
/// fork begins at its parent's.
json run_self(const std::vector<std::string>& arguments) {
  int channel[2];
  if (pipe(channel) != 0) throw std::runtime_error("no pipe");
  const pid_t child = fork();
  if (child < 0) throw std::runtime_error("no process");
  if (child == 0) {
    dup2(channel[1], STDOUT_FILENO);
    close(channel[0]);
    close(channel[1]);
    const std::string self = fs::read_symlink("/proc/self/exe").string();
    std::vector<char*> argv{const_cast<char*>(self.c_str())};
    for (const std::string& argument : arguments)
      argv.push_back(const_cast<char*>(argument.c_str()));
    argv.push_back(nullptr);
    execv(self.c_str(), argv.data());
    _exit(127);
  }
  close(channel[1]);
  std::string text;
  char buffer[4096];
  for (ssize_t got; (got = read(channel[0], buffer, sizeof buffer)) > 0;)
    text.append(buffer, std::size_t(got));
  close(channel[0]);
  int status = 0;
  waitpid(child, &status, 0);
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
    throw std::runtime_error("the measuring process failed");
  return json::parse(text);
}

int run(int argc, char** argv) {
  CLI::App app{
      "Measures how long a large soup takes to load from each format, and its peak memory."};
  std::string scene, folder, make_in, load_from;
  std::size_t triangles = 2000000;
  int repeats = 3;
  bool as_json = false, keep = false;
  std::vector<std::string> extensions{".glb", ".off"};
  app.add_option("scene", scene, "The small scene that the large one is made of");
  app.add_option("folder", folder, "Where the large files go");
  app.add_option("--triangles", triangles, "Split until there are at least so many")
      ->capture_default_str();
  app.add_option("--formats", extensions, "Extensions, as in .glb,.off,.ply")
      ->delimiter(',')
      ->capture_default_str();
  app.add_option("--repeats", repeats, "Loads a format; the fastest counts")
      ->check(CLI::Range(1, 100))
      ->capture_default_str();
  app.add_flag("--json", as_json, "The figures as JSON on standard output");
  app.add_flag("--keep", keep, "Leave the large files where they are");
  app.add_option("--make", make_in)->group("");
  app.add_option("--load", load_from)->group("");
  CLI11_PARSE(app, argc, argv);

  if (!load_from.empty()) return std::printf("%s\n", load(load_from).dump().c_str()) < 0;
  if (!make_in.empty())
    return std::printf("%s\n", make(scene, make_in, extensions, triangles).dump().c_str()) < 0;
  if (scene.empty() || folder.empty()) {
    std::fprintf(stderr, "%s", app.help().c_str());
    return 2;
  }

  std::string joined;
  for (const std::string& extension : extensions) joined += (joined.empty() ? "" : ",") + extension;
  const json made = run_self(
      {scene, "--make", folder, "--formats", joined, "--triangles", std::to_string(triangles)});
  json rows = json::array();
  bool same = true;
  for (const std::string& extension : extensions) {
    const fs::path path = fs::path(folder) / ("dense" + extension);
    json best;
    for (int i = 0; i < repeats; ++i) {
      json row = run_self({"--load", path.string()});
      if (best.is_null() || row["seconds"] < best["seconds"]) best = std::move(row);
    }
    best["format"] = extension;
    best["file_bytes"] = fs::file_size(path);
    best["write_seconds"] = made["write_seconds"][extension];
    best["same_soup"] = best["fingerprint"] == made["fingerprint"];
    same = same && best["same_soup"].get<bool>();
    best.erase("fingerprint");
    rows.push_back(std::move(best));
    if (!keep) fs::remove(path);
  }
  if (as_json) {
    std::printf("%s\n", rows.dump(2).c_str());
  } else {
    const auto mebibytes = [](const json& bytes) { return bytes.get<double>() / (1 << 20); };
    std::printf(
        "| format | triangles | file MiB | load s | of them busy | peak MiB | soup MiB | peak / "
        "soup |\n");
    std::printf("|---|---|---|---|---|---|---|---|\n");
    for (const json& row : rows)
      std::printf("| %s | %zu | %.0f | %.2f | %.2f | %.0f | %.0f | %.2f |\n",
                  row["format"].get<std::string>().c_str(), row["triangles"].get<std::size_t>(),
                  mebibytes(row["file_bytes"]), row["seconds"].get<double>(),
                  row["cpu_seconds"].get<double>(), mebibytes(row["peak_bytes"]),
                  mebibytes(row["soup_bytes"]), row["ratio"].get<double>());
  }
  if (!same) std::fprintf(stderr, "a file did not read back as the soup that was written\n");
  return same ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
