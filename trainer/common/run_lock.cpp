#include "trainer/common/run_lock.hpp"

#include "base/error.hpp"

namespace tureen::trainer {

RunLock::RunLock(const std::filesystem::path& file) : lock_(file) {
  if (!lock_.is_held())
    throw UsageError("another run is writing the files beside " + file.string(),
                     "wait for it, stop it, or choose another name with -o");
}

}  // namespace tureen::trainer
