// A scene as one HTML page that opens by double-click: the web build's viewer, with a Tureen GLB in
// base64.
//
// This code depends only on the scene element of the template.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "scene/scene.hpp"

namespace tureen::cli {

/// The scene element. The template has exactly this text, once. A page has the escaped name of the
/// scene in data-name, and the base64 digits between the tags.
inline constexpr char scene_element[] =
    R"(<script type="application/octet-stream;base64" id="scene" data-name=""></script>)";

/// Largest GLB for a page, in bytes: base64 is a third larger, and a string in a browser has at
/// most 2^29 - 24 characters.
inline constexpr std::uint64_t max_scene_page_bytes = 400'000'000;

/// Whether the output is a page: its name ends in .html.
bool is_scene_page(const std::filesystem::path& path);

class ScenePageTemplate {
 public:
  /// The file in the environment variable TUREEN_WEB_TEMPLATE. Without it,
  /// ../share/tureen/scene_template.html relative to the program's folder, then
  /// share/tureen/scene_template.html in that folder. Throws OutputError if there is no file,
  /// InputError if it cannot be read or does not have exactly one scene element.
  static ScenePageTemplate find();

  /// `text` is the template; `file` names it in errors. Throws InputError.
  ScenePageTemplate(std::string text, const std::string& file);

  /// Writes the page, completely or not at all, and reads the Tureen GLB in pieces. Throws
  /// UsageError if it is too large, InputError and OutputError.
  void write(const std::filesystem::path& glb, const std::string& name,
             const std::filesystem::path& page) const;

 private:
  std::string text_;
  std::size_t element_ = 0;  // offset of the scene element
};

/// The scene as a page, by a file beside it that is removed. Returns one sentence for each loss.
/// Throws the errors of write_scene() and ScenePageTemplate::write().
std::vector<std::string> write_page(const ScenePageTemplate& page, const Scene& scene,
                                    const std::filesystem::path& output);

/// Whether the file is a Tureen GLB. A page contains its bytes unchanged.
bool is_our_glb(const std::filesystem::path& path);

}  // namespace tureen::cli
