#include "base/platform/program_folder.hpp"

namespace tureen {

std::optional<std::filesystem::path> program_folder() {
  std::error_code failed;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", failed);
  if (failed) return std::nullopt;
  return program.parent_path();
}

std::string program_beside(const std::string& name) {
  std::error_code ignored;
  if (const auto folder = program_folder())
    if (const auto beside = *folder / name; std::filesystem::exists(beside, ignored))
      return beside.string();
  return name;
}

}  // namespace tureen
