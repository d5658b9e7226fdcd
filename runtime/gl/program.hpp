// A linked shader program and its uniforms by name. Their locations are looked up once, at link.
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "runtime/gl/objects.hpp"

namespace tureen::gl {

class Program {
 public:
  Program() = default;
  /// Compiles and links complete sources (with their version line). A failure is a bug of ours or
  /// of a driver: throws ContextError with the driver's log and the numbered source.
  Program(const std::string& vertex_source, const std::string& fragment_source);

  /// A compute program, for contexts with Capabilities::compute_shaders; throws the same errors.
  static Program compute(const std::string& source);

  void use() const { glUseProgram(object_.id()); }

  // Uniforms of the program in use; a name that the linker has removed is ignored.
  void set(const char* name, int value) const;
  void set(const char* name, float value) const;
  void set(const char* name, const glm::ivec2& value) const;
  void set(const char* name, const glm::vec2& value) const;
  void set(const char* name, const glm::vec3& value) const;
  void set(const char* name, const glm::vec4& value) const;
  void set(const char* name, const glm::mat3& value) const;
  void set(const char* name, const glm::mat4& value) const;
  void set(const char* name, std::span<const glm::mat4> values) const;
  void set(const char* name, std::span<const glm::vec4> values) const;

  /// Binds a texture to a unit, without a sampler object that would override its filters, and sets
  /// the sampler `name` of the program in use to this unit.
  void set_texture(const char* name, int unit, GLuint texture, GLenum kind = GL_TEXTURE_2D) const;

 private:
  void link();
  void look_up_uniforms();
  /// -1, which GL ignores, for a name that the program does not use.
  GLint location(const char* name) const;

  Object<ProgramTraits> object_;
  std::vector<std::pair<std::string, GLint>> locations_;  // by name
};

}  // namespace tureen::gl
