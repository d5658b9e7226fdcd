// Move-only ownership of GL objects. Construction binds an object only if necessary. Functions
// change GL state only as their names imply. The context must be current, also on destruction.
#pragma once

#include <utility>

#include "runtime/gl/api.hpp"

namespace tureen::gl {

/// One GL name; `Traits` creates and deletes it. Move assignment swaps.
template <class Traits>
class Object {
 public:
  /// No object: id() is 0.
  Object() = default;
  static Object create() {
    Object object;
    object.id_ = Traits::create();
    return object;
  }
  Object(Object&& other) noexcept : id_(std::exchange(other.id_, 0)) {}
  Object& operator=(Object&& other) noexcept {
    std::swap(id_, other.id_);
    return *this;
  }
  ~Object() {
    if (id_) Traits::destroy(id_);
  }
  GLuint id() const { return id_; }
  explicit operator bool() const { return id_ != 0; }

 private:
  GLuint id_ = 0;
};

struct BufferTraits {
  static GLuint create() {
    GLuint id;
    glGenBuffers(1, &id);
    return id;
  }
  static void destroy(GLuint id) { glDeleteBuffers(1, &id); }
};
struct TextureTraits {
  static GLuint create() {
    GLuint id;
    glGenTextures(1, &id);
    return id;
  }
  static void destroy(GLuint id) { glDeleteTextures(1, &id); }
};
struct FramebufferTraits {
  static GLuint create() {
    GLuint id;
    glGenFramebuffers(1, &id);
    return id;
  }
  static void destroy(GLuint id) { glDeleteFramebuffers(1, &id); }
};
struct VertexArrayTraits {
  static GLuint create() {
    GLuint id;
    glGenVertexArrays(1, &id);
    return id;
  }
  static void destroy(GLuint id) { glDeleteVertexArrays(1, &id); }
};
struct ProgramTraits {
  static GLuint create() { return glCreateProgram(); }
  static void destroy(GLuint id) { glDeleteProgram(id); }
};

using Buffer = Object<BufferTraits>;
using Texture = Object<TextureTraits>;
using Framebuffer = Object<FramebufferTraits>;
using VertexArray = Object<VertexArrayTraits>;

/// A vertex array created by the first bind() in the current context. Contexts that share buffers
/// and textures do not share vertex arrays.
class LocalVertexArray {
 public:
  /// Returns whether it was just created and needs its attributes.
  bool bind() {
    const bool made = !array_;
    if (made) array_ = VertexArray::create();
    glBindVertexArray(array_.id());
    return made;
  }
  void forget() { array_ = {}; }

 private:
  VertexArray array_;
};

}  // namespace tureen::gl
