// The one place where the generated GL loader is compiled.
#define GLAD_GL_IMPLEMENTATION
#include <glad/gl.h>
