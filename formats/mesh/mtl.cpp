#include "formats/mesh/mtl.hpp"

#include <algorithm>
#include <string_view>

#include "base/decimal.hpp"
#include "base/text_scanner.hpp"

namespace tureen {

namespace {

/// A node of the map, in bytes.
constexpr std::size_t bytes_a_material = sizeof(MtlMaterial) + 128;

/// Takes the next word of a line.
std::string_view next_mtl_word(std::string_view& line) {
  line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
  const std::string_view word = line.substr(0, line.find_first_of(" \t"));
  line.remove_prefix(word.size());
  return word;
}

bool is_mtl_number(std::string_view word) {
  const std::string text(word);
  const Decimal number = parse_decimal(text);
  return number.end && *number.end == '\0';
}

/// The name of the file in a line "[options] NAME", which may have blanks.
std::string mtl_file_name(std::string_view line, MtlMaterial& material) {
  while (true) {
    line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
    if (line.empty() || line.front() != '-') break;
    const std::string_view option = next_mtl_word(line);
    const bool has_vector = option == "-o" || option == "-s" || option == "-t";
    material.is_placed = material.is_placed || has_vector;
    const int most = has_vector ? 3 : option == "-mm" ? 2 : 1;
    for (int i = 0; i < most; ++i) {
      std::string_view rest = line;
      const std::string_view value = next_mtl_word(rest);
      if (has_vector && !is_mtl_number(value)) break;
      if (option == "-clamp") material.clamps = value == "on";
      line = rest;
    }
  }
  std::string name(line);
  std::replace(name.begin(), name.end(), '\\', '/');  // as Windows writes it
  return name;
}

}  // namespace

std::map<std::string, MtlMaterial> read_mtl(Input& input) {
  TextScanner text(input, {.comment = '#'});
  std::map<std::string, MtlMaterial> materials;
  MtlMaterial ignored, *material = &ignored;
  while (text.next_content()) {
    const std::string keyword(text.peek(8));
    const auto is = [&](std::string_view name) {
      if (keyword != name) return false;
      text.skip(name.size());
      return true;
    };
    if (is("newmtl")) {
      const std::string name = text.read_line();
      input.take_memory(1, bytes_a_material + name.size(), "the materials");
      material = &(materials[name] = {});
    } else if (is("Kd")) {
      // "Kd xyz" and "Kd spectral" name other colour spaces.
      if (!text.at_line_end() && text.peek(3) != "xyz" && text.peek(8) != "spectral") {
        const float r = text.read_float("red");
        // A single value is a grey.
        const float g = text.at_line_end() ? r : text.read_float("green");
        material->color = glm::vec3(r, g, text.at_line_end() ? g : text.read_float("blue"));
      }
    } else if (is("d")) {
      if (text.peek(5) != "-halo") material->opacity = text.read_float("the opacity");
    } else if (is("Tr")) {
      material->opacity = 1 - text.read_float("the transparency");
    } else if (is("map_Kd")) {
      material->image = mtl_file_name(text.read_line(), *material);
    } else if (is("map_d")) {
      material->mask = mtl_file_name(text.read_line(), ignored);
    }
    if (!text.next_line()) break;
  }
  return materials;
}

}  // namespace tureen
