#include "runtime/gl/allocation.hpp"

#include "runtime/gl/api.hpp"
#include "runtime/gl/context.hpp"

namespace tureen::gl {

bool is_refused(const std::function<void()>& allocate) {
  // Clears the errors of earlier calls. GL keeps each kind of error once, so a few reads suffice. A
  // lost device reports errors forever.
  for (int kinds = 0; kinds < 16 && glGetError() != GL_NO_ERROR; ++kinds) {
  }
  allocate();
  if (glGetError() == GL_NO_ERROR) return false;
  throw_if_lost();
  return true;
}

}  // namespace tureen::gl
