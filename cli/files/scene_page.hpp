// A scene as one HTML page that opens by double-click: the viewer that the web build leaves as a
// template, and in it our GLB in base64.
//
// What it does not do: it knows nothing of the template but the one element that takes the scene.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace tureen::cli {

/// The element as the template has it: exactly this text, once. A page has the scene's name in
/// data-name, escaped, and the digits between the tags.
inline constexpr char scene_element[] =
    R"(<script type="application/octet-stream;base64" id="scene" data-name=""></script>)";

/// As much of a GLB as fits into a page: base64 is a third larger, and a text in a browser has at
/// most 2^29 - 24 characters.
inline constexpr std::uint64_t max_scene_page_bytes = 400'000'000;

/// Whether the name says that a page is meant: it ends in .html.
bool is_scene_page(const std::filesystem::path& path);

class ScenePageTemplate {
 public:
  /// The file that the environment names in TUREEN_WEB_TEMPLATE, or else
  /// ../share/tureen/scene_template.html from where the program lies, or share/tureen/.. beside it.
  /// Throws OutputError where there is none, InputError where it cannot be read or has not the one
  /// element.
  static ScenePageTemplate find();

  /// `text` is the template; `file` names it in errors. Throws InputError.
  ScenePageTemplate(std::string text, const std::string& file);

  /// The page, whole or not at all; the GLB, any file of ours, goes through piece by piece. Throws
  /// UsageError where it is too large, InputError and OutputError.
  void write(const std::filesystem::path& glb, const std::string& name,
             const std::filesystem::path& page) const;

 private:
  std::string text_;
  std::size_t element_ = 0;  // where it begins
};

/// Whether the scene in this file is ours already: a page takes its bytes as they are.
bool is_our_glb(const std::filesystem::path& path);

}  // namespace tureen::cli
