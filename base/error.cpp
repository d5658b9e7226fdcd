#include "base/error.hpp"

namespace tureen {

std::string to_string(const FilePosition& position) {
  std::string text = position.file;
  if (position.line) text += ":" + std::to_string(*position.line);
  if (!text.empty()) text += ": ";
  if (position.byte) text += "byte " + std::to_string(*position.byte) + ": ";
  return text;
}

}  // namespace tureen
