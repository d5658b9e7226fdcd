// The implementation of tinygltf, for JSON only: no files, no images, no writing.
// formats/gltf/gltf_document.hpp has the reason.
#include "formats/gltf/tinygltf.hpp"

// All that tinygltf 2.7 includes, because `std` is another word below.
#include <algorithm>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <utility>

/// The standard library as tinygltf sees it. The only streams that it uses here build error
/// messages. With those of the library, a page would contain all locales: 24 KB more with brotli,
/// of 400.
namespace tinygltf_std {

using namespace std;

class stringstream {
 public:
  stringstream& operator<<(const char* text) { return text_ += text, *this; }
  stringstream& operator<<(const std::string& text) { return text_ += text, *this; }
  template <class Number>
  stringstream& operator<<(Number number) {
    return text_ += std::to_string(number), *this;
  }
  stringstream& operator<<(std::ostream& (*)(std::ostream&)) { return text_ += '\n', *this; }
  std::string str() const { return text_; }

 private:
  std::string text_;
};

}  // namespace tinygltf_std

#define std tinygltf_std
#define TINYGLTF_IMPLEMENTATION
#include <tiny_gltf.h>
#undef std
