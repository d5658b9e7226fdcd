// Covering samples of products, as the parameters of tests. `./dev test` needs no full product: a
// suite has a sample, and the rest is instantiated under `Thorough`, for `./dev test --all`:
//
//   INSTANTIATE_TEST_SUITE_P(, SplatOrders, in_contexts(splat_kinds), name_in_context);
//   INSTANTIATE_TEST_SUITE_P(Thorough, SplatOrders, in_other_contexts(splat_kinds),
//                            name_in_context);
//
// Contexts and values: contexts differ in shader language, clip control and driver, and some values
// show that; values differ in what is drawn, and one context shows that. So OSMesa has all values,
// and the other contexts share them: each value is in exactly one of them, by turns.
//
// Values and two flags: a half that has each value with each flag, and the flags in all four
// combinations. A fault that depends on two of the three is in it.
#pragma once

#include <gtest/gtest.h>

#include <cstddef>
#include <iterator>
#include <ranges>
#include <span>
#include <string>
#include <tuple>
#include <type_traits>
#include <vector>

#include "tests/support/contexts.hpp"

namespace tureen::test {

// -- contexts and values --------------------------------------------------------------------------

/// The parameter of such a test.
template <class Value>
using InContext = std::tuple<NamedContext, Value>;

/// The pairs of the sample, or all others. The first context has all values.
template <class Values>
auto context_pairs(const Values& values, bool of_the_sample,
                   std::span<const NamedContext> contexts) {
  const std::size_t others = contexts.size() - 1;
  std::vector<InContext<std::ranges::range_value_t<const Values&>>> pairs;
  for (std::size_t context = 0; context < contexts.size(); ++context) {
    std::size_t i = 0;
    for (const auto& value : values) {
      const bool is_sampled = context == 0 || 1 + i++ % others == context;
      if (is_sampled == of_the_sample) pairs.emplace_back(contexts[context], value);
    }
  }
  return testing::ValuesIn(pairs);
}

template <class Values>
auto in_contexts(const Values& values, std::span<const NamedContext> contexts = every_context) {
  return context_pairs(values, true, contexts);
}

template <class Values>
auto in_other_contexts(const Values& values,
                       std::span<const NamedContext> contexts = every_context) {
  return context_pairs(values, false, contexts);
}

/// The name of such a parameter: "osmesa_windows". A value has a name or to_string(), or is text.
struct NameInContext {
  template <class Value>
  std::string operator()(const testing::TestParamInfo<InContext<Value>>& info) const {
    const auto& [context, value] = info.param;
    std::string name = std::string(context.name) + "_";
    if constexpr (requires { name += value.name; })
      name += value.name;
    else if constexpr (std::is_convertible_v<Value, std::string>)
      name += value;
    else
      name += to_string(value);
    return name;
  }
};
inline constexpr NameInContext name_in_context;

/// For tests without a value that a quicker test covers in the other contexts: OSMesa alone.
inline auto in_osmesa() { return testing::Values(every_context[0]); }

/// The contexts other than OSMesa, for `Thorough`.
inline auto in_the_others() {
  return testing::ValuesIn(std::begin(every_context) + 1, std::end(every_context));
}

/// The name of a context as a parameter.
inline constexpr auto context_name = [](const testing::TestParamInfo<NamedContext>& info) {
  return std::string(info.param.name);
};

// -- values and two flags -------------------------------------------------------------------------

/// The half of the sample, or the other one.
template <class Values>
auto half_with_flags(const Values& values, bool of_the_sample) {
  std::vector<std::tuple<std::ranges::range_value_t<const Values&>, bool, bool>> half;
  bool is_odd = false;
  for (const auto& value : values) {
    for (const bool first : {false, true})
      half.emplace_back(value, first, first != (is_odd == of_the_sample));
    is_odd = !is_odd;
  }
  return testing::ValuesIn(half);
}

template <class Values>
auto with_flags(const Values& values) {
  return half_with_flags(values, true);
}

template <class Values>
auto with_other_flags(const Values& values) {
  return half_with_flags(values, false);
}

}  // namespace tureen::test
