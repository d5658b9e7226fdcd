// Options of all writers. A writer applies those that concern its format.
#pragma once

#include <functional>

namespace tureen {

struct WriteOptions {
  int spz_version = 4;  // or 3, for programs without version 4
  /// As that of write_tureen_glb(); other writers do not call it.
  std::function<void(double)> progress = {};
};

}  // namespace tureen
