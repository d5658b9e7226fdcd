#include "cli/files/scratch.hpp"

#include "base/error.hpp"

namespace tureen::cli {

Scratch::Scratch(std::filesystem::path path, const char* purpose) : path_(std::move(path)) {
  std::error_code error;
  if (std::filesystem::exists(path_, error))
    throw UsageError(path_.string() + " exists; rename it: " + purpose +
                     " needs this name temporarily");
}

Scratch::~Scratch() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

}  // namespace tureen::cli
