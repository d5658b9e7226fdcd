#include "runtime/passes/shader_source.hpp"

#include <cassert>
#include <set>

#include "shaders/shaders.hpp"

namespace tureen {

namespace {

constexpr std::string_view include_directive = "#include \"";

class Assembler {
 public:
  Assembler(const ShaderSource& source, std::string& out) : source_(source), out_(out) {}

  void append_file(std::string_view name) {
    if (!included_.insert(std::string(name)).second) return;
    const auto generated = source_.generated.find(std::string(name));
    const std::string_view text = generated != source_.generated.end()
                                      ? std::string_view(generated->second)
                                      : shaders::text(name);
    assert(!text.empty() && "no such shader file");
    append_text(text);
  }

 private:
  void append_text(std::string_view text) {
    while (!text.empty()) {
      const std::size_t end = text.find('\n');
      const std::string_view line = text.substr(0, end);
      if (line.substr(0, include_directive.size()) == include_directive) {
        const std::string_view rest = line.substr(include_directive.size());
        append_file(rest.substr(0, rest.find('"')));
      } else {
        out_ += line;
        out_ += '\n';
      }
      if (end == std::string_view::npos) break;
      text.remove_prefix(end + 1);
    }
  }

  const ShaderSource& source_;
  std::string& out_;
  std::set<std::string> included_;
};

std::string version_line(std::string_view file, gl::Api api) {
  constexpr std::string_view compute = ".comp";
  const bool computes =
      file.size() > compute.size() && file.substr(file.size() - compute.size()) == compute;
  if (api == gl::Api::es) return computes ? "#version 310 es\n" : "#version 300 es\n";
  return computes ? "#version 430 core\n" : "#version 330 core\n";
}

}  // namespace

std::string assemble(const ShaderSource& source, gl::Api api) {
  std::string out = version_line(source.file, api);
  // Phones have 16-bit medium floats and 16-bit default integers; texel indices need 32.
  out +=
      "precision highp float;\n"
      "precision highp int;\n"
      "precision highp sampler2D;\n"
      "precision highp sampler2DArray;\n"
      "precision highp usampler2D;\n"
      "precision highp usampler2DArray;\n";
  for (const auto& [name, value] : source.constants) out += "#define " + name + " " + value + "\n";
  Assembler(source, out).append_file(source.file);
  return out;
}

}  // namespace tureen
