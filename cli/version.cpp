#include "cli/version.hpp"

#include "tureen_commit.hpp"  // of this build: cmake/commit.cmake

namespace tureen::cli {

const char* program_version() { return TUREEN_VERSION; }

const char* program_commit() { return TUREEN_COMMIT; }

const char* program_build() {
  if (TUREEN_SANITIZED) return "sanitized";
#ifdef NDEBUG
  return "release";
#else
  return "debug";
#endif
}

}  // namespace tureen::cli
