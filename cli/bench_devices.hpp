// Frame times of several devices side by side: what was measured on each, in one table.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "cli/bench_result.hpp"

namespace tureen::cli {

/// What one device measured.
struct DeviceBench {
  std::string name;                  // of the column
  std::vector<BenchResult> results;  // at least one; of one device, a scene each
};

/// A row for each scene, set of cameras, size and configuration that a device measured, in the
/// order in which they come; in a device's column the best milliseconds, the smallest of the
/// rounds' medians, or nothing.
struct DeviceTable {
  std::vector<std::string> devices;  // "phone: Adreno (TM) 740, ..", a line each
  std::vector<std::string> headings;
  std::vector<std::vector<std::string>> rows;
};

/// How many of a row's cells come before those of the devices.
inline constexpr std::size_t device_table_keys = 4;

DeviceTable device_table(std::span<const DeviceBench> devices);

/// For a terminal.
std::vector<std::string> device_lines(const DeviceTable& table);

/// To be put into documents.
std::string device_markdown(const DeviceTable& table);

/// A page, complete (cli/html_page.hpp).
std::string device_page(const DeviceTable& table);

}  // namespace tureen::cli
