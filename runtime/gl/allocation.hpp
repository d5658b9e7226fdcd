// Whether the device had memory for what it was asked to hold.
#pragma once

#include <functional>

namespace tureen::gl {

/// Calls `allocate`, one glBufferData or glTexImage, and says whether the device refused it. Throws
/// ContextError where it refused because it is gone (throw_if_lost). For loading: it waits for the
/// driver.
bool is_refused(const std::function<void()>& allocate);

}  // namespace tureen::gl
