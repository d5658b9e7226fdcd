// The options of a training run: those that every method has, and those that methods list
// (MethodOption), by name. A file of constants can set all constants; options set the most common
// ones.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tureen {

struct TrainingMethodInfo;

/// An option that some methods have, for a command line or a window. Its range and its default are
/// those of the constant that it sets. Methods with an option of the same name share this value.
struct MethodOption {
  enum class Type {
    flag,    // given or not
    whole,   // a whole number
    number,  // a finite number
    word,    // one of `words`
    path,
  };
  const char* name;  // --NAME on a command line
  Type type = Type::flag;
  const char* help;
  const char* instead;                       // hint of the error for methods without the option
  const char* value_name = "";               // in --help
  std::vector<std::string> words = {};       // of Type::word
  std::vector<std::string> everywhere = {};  // the words that methods without the option accept
  bool is_common = false;                    // windows show it among the first
};

/// The value of an option; the member of its type is set if it is given.
struct OptionValue {
  bool flag = false;
  std::optional<std::int64_t> whole = {};
  std::optional<double> number = {};
  std::string text = {};  // of a word or a path; empty: not given

  bool is_given() const { return flag || whole || number || !text.empty(); }
};

struct TrainingOptions {
  TrainingOptions();  // the first method

  const TrainingMethodInfo* method;   // in training_methods()
  std::string file;                   // of constants; empty: none
  std::optional<std::int64_t> steps;  // ranges are checked with the constants
  std::optional<std::uint64_t> seed;
  std::optional<std::uint64_t> max_memory;              // bytes; methods that can need less then do
  std::string begin;                                    // "random", "points", a scene, or empty
  std::map<std::string, OptionValue, std::less<>> own;  // by MethodOption::name

  /// The value of an option of the method; without a value if it is not given.
  const OptionValue& operator[](const MethodOption& option) const;
  /// The scene that provides the first primitives; empty: none.
  std::string mesh() const {
    return begin == "random" || begin == "points" ? std::string() : begin;
  }
};

/// An option, and the methods that have it, in their order.
struct OptionOfMethods {
  const MethodOption* option;
  std::vector<const TrainingMethodInfo*> methods;
};
/// All options of all methods: those of the first method, then the further ones of the next.
std::vector<OptionOfMethods> all_method_options();

/// "diffsoup", "gaussians or triangles" with the separator " or ".
std::string names_of(const std::vector<const TrainingMethodInfo*>& methods,
                     std::string_view separator);

}  // namespace tureen
