#include "splatting/discs/disc_entries.hpp"

namespace tureen::splatting {

namespace row = projected_disc_row;

DiscEntry disc_entry(const ParameterRows& projected, std::size_t i) {
  const auto value = [&](std::size_t which) { return projected.row(which)[i]; };
  return {value(row::x),   value(row::y),     value(row::u_x), value(row::v_x),
          value(row::c_x), value(row::u_y),   value(row::v_y), value(row::c_y),
          value(row::u_w), value(row::v_w),   value(row::c_w), value(row::log_opacity),
          value(row::red), value(row::green), value(row::blue)};
}

Box disc_box(const ParameterRows& projected, std::size_t i) {
  const auto value = [&](std::size_t which) { return projected.row(which)[i]; };
  return {value(row::left), value(row::right), value(row::top), value(row::bottom)};
}

}  // namespace tureen::splatting
