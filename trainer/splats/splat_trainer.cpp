#include "trainer/splats/splat_trainer.hpp"

namespace tureen::trainer {

namespace {

constexpr std::size_t squares_a_sum = 512;  // in single precision

}  // namespace

double mean_squared_error(std::span<const float> planes, const TrainingView& view) {
  const std::vector<std::uint8_t>&target = view.target, &ignored = view.ignored;
  const std::size_t plane = target.size() / 3;
  double sum = 0, values = 0;
  for (std::size_t i = 0; i < target.size(); i += squares_a_sum) {
    const std::size_t count = std::min(squares_a_sum, target.size() - i);
    float squares[squares_a_sum];
    for (std::size_t k = 0; k < count; ++k) {
      const float difference = planes[i + k] - float(target[i + k]) / 255.0f;
      squares[k] = difference * difference;
    }
    for (std::size_t k = 0; k < count && !ignored.empty(); ++k)
      if (ignored[(i + k) % plane]) squares[k] = 0;
    float lanes[8] = {};
    for (std::size_t k = 0; k < count; ++k) lanes[k % 8] += squares[k];
    for (const float lane : lanes) sum += double(lane);
  }
  for (const std::uint8_t each : ignored) values += each ? 0 : 3;
  if (ignored.empty()) values = double(target.size());
  return values > 0 ? sum / values : 0;
}

}  // namespace tureen::trainer
