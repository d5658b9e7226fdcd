// The GL functions that we call: the common subset of OpenGL 3.3 core and OpenGL ES 3.0, and
// additions of newer contexts. They are loaded at run time; no GL library is linked.
#pragma once

#ifdef __EMSCRIPTEN__
#include <GLES3/gl3.h>
#else
#include <glad/gl.h>
#endif

namespace tureen::gl {

/// Throws std::logic_error if GL reports an error. Debug builds only, since glGetError waits for
/// the driver, which is too slow for a frame.
#ifndef NDEBUG
void check(const char* where);
#else
inline void check(const char*) {}
#endif

}  // namespace tureen::gl
