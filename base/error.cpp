#include "base/error.hpp"

namespace tureen {

std::string to_string(const Place& place) {
  std::string text = place.file;
  if (place.line) text += ":" + std::to_string(*place.line);
  if (!text.empty()) text += ": ";
  if (place.byte) text += "byte " + std::to_string(*place.byte) + ": ";
  return text;
}

}  // namespace tureen
