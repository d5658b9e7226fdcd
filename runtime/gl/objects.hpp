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

/// For GL's functions that create and delete any number of names.
template <auto& generate, auto& remove>
struct NameTraits {
  static GLuint create() {
    GLuint id;
    generate(1, &id);
    return id;
  }
  static void destroy(GLuint id) { remove(1, &id); }
};
struct ProgramTraits {
  static GLuint create() { return glCreateProgram(); }
  static void destroy(GLuint id) { glDeleteProgram(id); }
};

using Buffer = Object<NameTraits<glGenBuffers, glDeleteBuffers>>;
using Texture = Object<NameTraits<glGenTextures, glDeleteTextures>>;
using Framebuffer = Object<NameTraits<glGenFramebuffers, glDeleteFramebuffers>>;
using VertexArray = Object<NameTraits<glGenVertexArrays, glDeleteVertexArrays>>;

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
