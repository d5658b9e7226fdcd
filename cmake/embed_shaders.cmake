# Turns GLSL files into one C++ source with a table of (name, text). Run as a script:
#   cmake -DOUTPUT=x.cpp -DFILES="a.glsl;b.frag" -P embed_shaders.cmake
set(entries "")
foreach(file IN LISTS FILES)
  get_filename_component(name "${file}" NAME)
  file(READ "${file}" text)
  string(APPEND entries "    {\"${name}\", R\"~glsl~(${text})~glsl~\"},\n")
endforeach()
file(WRITE "${OUTPUT}"
"// Generated from shaders/ by cmake/embed_shaders.cmake.
#include \"shaders/shaders.hpp\"

namespace tureen::shaders {

namespace {
struct File {
  std::string_view name;
  std::string_view text;
};
constexpr File files[] = {
${entries}};
}  // namespace

std::string_view text(std::string_view name) {
  for (const File& file : files)
    if (file.name == name) return file.text;
  return {};
}

}  // namespace tureen::shaders
")
