#include "runtime/gl/allocation.hpp"

#include "runtime/gl/api.hpp"
#include "runtime/gl/context.hpp"

namespace tureen::gl {

bool is_refused(const std::function<void()>& allocate) {
  // Somebody else's errors must not read as ours. There are at most a few kinds of them, each kept
  // once; a device that never ends telling of errors is gone.
  for (int kinds = 0; kinds < 16 && glGetError() != GL_NO_ERROR; ++kinds) {
  }
  allocate();
  if (glGetError() == GL_NO_ERROR) return false;
  throw_if_lost();
  return true;
}

}  // namespace tureen::gl
