// Detects failed allocations on the device.
#pragma once

#include <functional>

namespace tureen::gl {

/// Calls `allocate`, one glBufferData or glTexImage, and returns whether the device refused it.
/// Throws ContextError if the device is lost (throw_if_lost). Only for loading, since it waits for
/// the driver.
bool is_refused(const std::function<void()>& allocate);

}  // namespace tureen::gl
