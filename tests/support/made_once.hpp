// Slow values that several tests of one program share, above all images by the oracle.
#pragma once

#include <map>
#include <type_traits>

namespace tureen::test {

/// What make() returns for `key`, made by the first call with this key. Each call in the source has
/// values of its own. `key` must distinguish everything that make() depends on.
template <class Key, class Make>
const std::invoke_result_t<Make>& made_once(const Key& key, Make make) {
  static std::map<Key, std::invoke_result_t<Make>> made;
  const auto found = made.find(key);
  return found != made.end() ? found->second : made.emplace(key, make()).first->second;
}

}  // namespace tureen::test
