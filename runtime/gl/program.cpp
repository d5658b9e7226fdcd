#include "runtime/gl/program.hpp"

#include <algorithm>
#include <cassert>
#include <glm/gtc/type_ptr.hpp>
#include <string_view>

#include "base/error.hpp"

namespace tureen::gl {

namespace {

std::string numbered(const std::string& source) {
  std::string result;
  int number = 0;
  for (std::size_t begin = 0; begin < source.size();) {
    const std::size_t end = std::min(source.find('\n', begin), source.size());
    result += std::to_string(++number) + ": " + source.substr(begin, end - begin) + "\n";
    begin = end + 1;
  }
  return result;
}

/// A compiled shader, deleted at the end of the scope: the program keeps it alive as long as
/// needed.
class Shader {
 public:
  Shader(GLenum stage, const std::string& source) : id_(glCreateShader(stage)) {
    const char* text = source.c_str();
    glShaderSource(id_, 1, &text, nullptr);
    glCompileShader(id_);
    GLint compiled = 0;
    glGetShaderiv(id_, GL_COMPILE_STATUS, &compiled);
    if (compiled) return;
    char log[4096] = "";
    glGetShaderInfoLog(id_, sizeof log, nullptr, log);
    glDeleteShader(id_);
    throw ContextError("the driver rejects a shader: " + std::string(log) + numbered(source));
  }
  Shader(const Shader&) = delete;
  Shader& operator=(const Shader&) = delete;
  ~Shader() { glDeleteShader(id_); }
  GLuint id() const { return id_; }

 private:
  GLuint id_;
};

}  // namespace

Program::Program(const std::string& vertex_source, const std::string& fragment_source)
    : object_(Object<ProgramTraits>::create()) {
  const Shader vertex(GL_VERTEX_SHADER, vertex_source);
  const Shader fragment(GL_FRAGMENT_SHADER, fragment_source);
  glAttachShader(object_.id(), vertex.id());
  glAttachShader(object_.id(), fragment.id());
  link();
}

Program Program::compute(const std::string& source) {
  Program program;
#ifdef __EMSCRIPTEN__
  (void)source;
  assert(false && "WebGL has no compute shaders");
#else
  program.object_ = Object<ProgramTraits>::create();
  const Shader shader(GL_COMPUTE_SHADER, source);
  glAttachShader(program.object_.id(), shader.id());
  program.link();
#endif
  return program;
}

void Program::link() {
  glLinkProgram(object_.id());
  GLint linked = 0;
  glGetProgramiv(object_.id(), GL_LINK_STATUS, &linked);
  if (linked) return look_up_uniforms();
  char log[4096] = "";
  glGetProgramInfoLog(object_.id(), sizeof log, nullptr, log);
  throw ContextError("the driver cannot link a program: " + std::string(log));
}

void Program::look_up_uniforms() {
  GLint count = 0;
  glGetProgramiv(object_.id(), GL_ACTIVE_UNIFORMS, &count);
  for (GLuint i = 0; i < static_cast<GLuint>(count); ++i) {
    char name[256] = "";
    GLint elements = 0;
    GLenum type = 0;
    glGetActiveUniform(object_.id(), i, sizeof name, nullptr, &elements, &type, name);
    const GLint found = glGetUniformLocation(object_.id(), name);
    // Arrays are reported by their first element.
    const std::string_view text(name);
    locations_.emplace_back(text.substr(0, text.find('[')), found);
  }
  std::sort(locations_.begin(), locations_.end());
}

GLint Program::location(const char* name) const {
  const std::string_view wanted(name);
  const auto at =
      std::lower_bound(locations_.begin(), locations_.end(), wanted,
                       [](const auto& known, std::string_view each) { return known.first < each; });
  return at != locations_.end() && at->first == wanted ? at->second : -1;
}

void Program::set(const char* name, int value) const { glUniform1i(location(name), value); }
void Program::set(const char* name, float value) const { glUniform1f(location(name), value); }
void Program::set(const char* name, const glm::ivec2& value) const {
  glUniform2iv(location(name), 1, glm::value_ptr(value));
}
void Program::set(const char* name, const glm::vec2& value) const {
  glUniform2fv(location(name), 1, glm::value_ptr(value));
}
void Program::set(const char* name, const glm::vec3& value) const {
  glUniform3fv(location(name), 1, glm::value_ptr(value));
}
void Program::set(const char* name, const glm::vec4& value) const {
  glUniform4fv(location(name), 1, glm::value_ptr(value));
}
void Program::set(const char* name, const glm::mat3& value) const {
  glUniformMatrix3fv(location(name), 1, GL_FALSE, glm::value_ptr(value));
}
void Program::set(const char* name, const glm::mat4& value) const {
  glUniformMatrix4fv(location(name), 1, GL_FALSE, glm::value_ptr(value));
}
void Program::set(const char* name, std::span<const glm::mat4> values) const {
  if (values.empty()) return;
  glUniformMatrix4fv(location(name), static_cast<GLsizei>(values.size()), GL_FALSE,
                     glm::value_ptr(values.front()));
}
void Program::set(const char* name, std::span<const glm::vec4> values) const {
  if (values.empty()) return;
  glUniform4fv(location(name), static_cast<GLsizei>(values.size()), glm::value_ptr(values.front()));
}

void Program::set_texture(const char* name, int unit, GLuint texture, GLenum kind) const {
  glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
  glBindTexture(kind, texture);
  glBindSampler(static_cast<GLuint>(unit), 0);
  set(name, unit);
}

}  // namespace tureen::gl
