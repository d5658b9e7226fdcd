// Which photographs of a dataset are test views.
#pragma once

#include <string>
#include <vector>

#include "formats/dataset/dataset_frame.hpp"
#include "scene/remark.hpp"

namespace tureen {

using Frames = std::vector<DatasetFrame>;

/// Names of photographs in the lists of a dataset.
struct NamedSplit {
  std::vector<std::string> train = {}, validation = {}, test = {};
  std::string source = {};  // what has the lists, for the remark
};

struct SplitFrames {
  Frames train, test;
  std::vector<Remark> remarks = {};
};

/// Both parts in the order of their names. If the lists name test photographs, those are the test
/// views; without them, those for validation. The others are training views, but if there is a list
/// of these, only they. Lists that name none of the frames count for nothing. Then every n-th frame
/// in name order is a test view, beginning with the first; the only one is a training view, unless
/// `needs_test`.
SplitFrames split(Frames all, const NamedSplit& named, int test_every, bool needs_test);

void sort_by_name(Frames& frames);

}  // namespace tureen
