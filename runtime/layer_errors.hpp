// Errors about memory that name the layer. Internal to runtime/.
#pragma once

#include <string>

#include "base/error.hpp"

namespace tureen {

/// Calls act(), and adds the name of a layer to its DeviceLimitError. An empty name adds nothing.
template <class Act>
void with_layer_in_errors(const std::string& name, const Act& act) {
  try {
    act();
  } catch (const DeviceLimitError& error) {
    if (name.empty()) throw;
    throw DeviceLimitError("layer " + name + ": " + error.reason(), error.hint());
  }
}

}  // namespace tureen
