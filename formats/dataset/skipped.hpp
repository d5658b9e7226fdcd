// Photographs of a dataset that are skipped, because one bad item costs that item.
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "scene/remark.hpp"

namespace tureen {

class SkippedPhotographs {
 public:
  /// `reason`: a clause: "its pose is not finite".
  void add(const std::string& name, const std::string& reason);

  /// Throws InputError with the reasons if any is skipped and `is_strict`, or fewer than three are
  /// left, or fewer than half. `left`: the number of the others.
  void require_enough(const std::string& file, std::size_t left, bool is_strict) const;

  /// A remark for each reason, with the names. `left`: as above.
  void add_remarks(std::vector<Remark>& list, std::size_t left) const;

 private:
  std::string sentences() const;

  std::vector<std::pair<std::string, std::vector<std::string>>> names_;  // by reason
  std::size_t count_ = 0;
};

}  // namespace tureen
