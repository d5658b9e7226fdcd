#include "base/platform/machine.hpp"

#include <cstdlib>
#include <fstream>
#include <thread>

#if defined(__linux__) || defined(__APPLE__)
#include <sys/resource.h>
#endif

namespace tureen {

namespace {

/// The text after "key   :" in a /proc file with lines of this form; empty if there is none.
std::string value_of(const char* file, const std::string& key) {
  std::ifstream lines(file);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t colon = line.find(':');
    if (colon == std::string::npos || line.compare(0, key.size(), key) != 0) continue;
    const std::size_t begin = line.find_first_not_of(" \t", colon + 1);
    return begin == std::string::npos ? "" : line.substr(begin);
  }
  return {};
}

}  // namespace

Machine this_machine() {
  Machine machine;
  if (const std::string cpu = value_of("/proc/cpuinfo", "model name"); !cpu.empty())
    machine.cpu = cpu;
  machine.cores = int(std::thread::hardware_concurrency());
  if (const std::string total = value_of("/proc/meminfo", "MemTotal"); !total.empty())
    machine.memory_mib = std::strtod(total.c_str(), nullptr) / 1024;  // "8048576 kB"
  return machine;
}

std::optional<int> rasteriser_threads_of(const std::string& renderer) {
  if (renderer.find("llvmpipe") == std::string::npos) return {};
  const int cores = int(std::thread::hardware_concurrency());
  if (const char* asked = std::getenv("LP_NUM_THREADS")) {
    constexpr long most = 1 << 16;  // more than any machine has, and an int
    char* end = nullptr;
    const long threads = std::strtol(asked, &end, 0);
    if (end != asked && threads >= 0 && threads <= most) return int(threads);
  }
  return cores > 1 ? cores : 0;
}

double peak_mib() {
#if defined(__linux__) || defined(__APPLE__)
  rusage usage{};
  if (getrusage(RUSAGE_SELF, &usage) != 0) return 0;
#ifdef __APPLE__
  return double(usage.ru_maxrss) / (1 << 20);  // bytes
#else
  return double(usage.ru_maxrss) / (1 << 10);  // KiB
#endif
#else
  return 0;
#endif
}

}  // namespace tureen
