// The proportional font of the window. The fonts of a replayed session do not depend on the
// machine, because golden images show them.
#pragma once

struct ImFontAtlas;

namespace tureen::viewer {

enum class FontChoice {
  /// A sans-serif font of the machine: common ones by their paths, otherwise fontconfig's default.
  machine,
  /// DejaVu Sans by its path (Debian: fonts-dejavu-core), so that all machines show the same.
  fixed,
};

struct FontSize {
  double points = 14;  // of the em square, as in CSS
  double scale = 1;    // font pixels in a point
};

/// Adds a font for text, its bold weight for headings, and that in a larger size for titles, in
/// this order. Without a usable font, adds only Dear ImGui's own, which is monospaced and has only
/// Latin letters.
void add_fonts(ImFontAtlas& atlas, FontChoice choice, const FontSize& size);

}  // namespace tureen::viewer
