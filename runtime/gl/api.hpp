// The GL functions that we call: the common subset of OpenGL 3.3 core and OpenGL ES 3.0, and what
// newer contexts add. Loaded at run time; there is no link against any GL library.
#pragma once

#ifdef __EMSCRIPTEN__
#include <GLES3/gl3.h>
#else
#include <glad/gl.h>
#endif

namespace tureen::gl {

/// Throws std::logic_error when GL reports an error. Debug builds only: glGetError waits for the
/// driver, which a frame cannot afford.
#ifndef NDEBUG
void check(const char* where);
#else
inline void check(const char*) {}
#endif

}  // namespace tureen::gl
