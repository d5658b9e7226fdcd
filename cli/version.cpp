#include "cli/version.hpp"

#include "tureen_commit.hpp"  // of this build: cmake/commit.cmake

namespace tureen::cli {

const char* program_version() { return TUREEN_VERSION; }

const char* program_commit() { return TUREEN_COMMIT; }

const char* program_build() {
#if defined __SANITIZE_ADDRESS__ || defined __SANITIZE_THREAD__
  return "sanitized";
#elif defined NDEBUG
  return "release";
#else
  return "debug";
#endif
}

}  // namespace tureen::cli
