#include "cli/files/scene_page.hpp"

#include <array>
#include <cstdlib>
#include <optional>
#include <string_view>

#include "base/base64.hpp"
#include "base/error.hpp"
#include "base/extension.hpp"
#include "base/html_escape.hpp"
#include "base/input.hpp"
#include "base/output.hpp"
#include "base/platform/program_folder.hpp"
#include "cli/files/scratch.hpp"
#include "formats/glb/glb_container.hpp"
#include "formats/scene_file.hpp"
#include "formats/tureen_glb/tureen_glb.hpp"

namespace tureen::cli {

namespace {

namespace fs = std::filesystem;

constexpr const char* template_variable = "TUREEN_WEB_TEMPLATE";

std::optional<fs::path> template_of_program() {
  const std::optional<fs::path> folder = program_folder();
  if (!folder) return std::nullopt;
  std::error_code ignored;
  // Beside bin/ in builds and installations, beside the program in a portable folder.
  for (const fs::path& place : {folder->parent_path(), *folder})
    if (const fs::path file = place / "share/tureen/scene_template.html"; fs::exists(file, ignored))
      return file;
  return std::nullopt;
}

ScenePageTemplate read_template(const fs::path& path) {
  return ScenePageTemplate(Input::open(path).read_text(), path.string());
}

}  // namespace

bool is_scene_page(const fs::path& path) { return extension_of(path) == ".html"; }

bool is_our_glb(const fs::path& path) {
  if (!fs::is_regular_file(path)) return false;
  Input input = Input::open(path);
  return is_glb(input) && is_tureen_glb(read_glb_container(input));
}

ScenePageTemplate ScenePageTemplate::find() {
  const char* named = std::getenv(template_variable);
  if (named && *named) return read_template(named);
  if (const std::optional<fs::path> file = template_of_program()) return read_template(*file);
  throw OutputError(
      {}, "cannot find share/tureen/scene_template.html, the viewer for .html pages",
      std::string("build it with ./dev web, or set ") + template_variable + " to its path");
}

ScenePageTemplate::ScenePageTemplate(std::string text, const std::string& file)
    : text_(std::move(text)), element_(text_.find(scene_element)) {
  if (element_ == std::string::npos)
    throw InputError({file}, std::string("not a template for a scene: it lacks ") + scene_element);
  if (const std::size_t second = text_.find(scene_element, element_ + 1);
      second != std::string::npos)
    throw InputError({file, second, {}},
                     std::string("not a template for a scene: it has a second ") + scene_element);
}

void ScenePageTemplate::write(const fs::path& glb, const std::string& name,
                              const fs::path& page) const {
  Input scene = Input::open(glb);
  if (scene.size() > max_scene_page_bytes)
    throw UsageError("the scene has " + std::to_string(scene.size()) +
                         " bytes; browsers open pages with at most " +
                         std::to_string(max_scene_page_bytes),
                     "use --compress, or publish a .glb of any size beside the viewer");
  const std::string_view text = text_, element = scene_element;
  const std::string_view name_at = R"(data-name=")", digits_at = R"(">)";
  const std::size_t name_begin = element_ + element.find(name_at) + name_at.size();
  const std::size_t digits_begin = name_begin + digits_at.size();

  Output output(page);
  output.write(text.substr(0, name_begin));
  output.write(html_escaped(name));
  output.write(digits_at);
  std::array<std::byte, 3 * 16384> piece;
  while (const std::size_t count = scene.read_some(piece))
    output.write(base64(std::span(piece).first(count)));
  output.write(text.substr(digits_begin));
  output.commit();
}

std::vector<std::string> write_page(const ScenePageTemplate& page, const Scene& scene,
                                    const fs::path& output) {
  const Scratch glb(output.string() + ".glb", "the scene for the page");
  const std::vector<std::string> lost = write_scene(scene, glb.path());
  page.write(glb.path(), scene.info.name, output);
  return lost;
}

}  // namespace tureen::cli
