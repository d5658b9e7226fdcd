#include "base/program_folder.hpp"

namespace tureen {

std::optional<std::filesystem::path> program_folder() {
  std::error_code failed;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", failed);
  if (failed) return std::nullopt;
  return program.parent_path();
}

}  // namespace tureen
