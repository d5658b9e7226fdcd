#include "splatting/depth_order.hpp"

namespace tureen::splatting {

void DepthOrder::make_runs() {
  splats_.resize(entries_.size());
  runs_.clear();
  for (std::uint32_t i = 0; i < entries_.size(); ++i) {
    const std::uint32_t number = entries_[i].index;
    std::uint32_t layer = runs_.empty() ? 0 : runs_.back().layer;
    while (number >= ends_[layer]) ++layer;
    while (layer > 0 && number < ends_[layer - 1]) --layer;
    splats_[i] = number - (layer > 0 ? ends_[layer - 1] : 0);
    if (runs_.empty() || runs_.back().layer != layer) runs_.push_back({layer, i, 0});
    ++runs_.back().count;
  }
}

}  // namespace tureen::splatting
