// Measurements of tests, as JSON lines: tests/measure.py joins them for `./dev numerics` and
// `./dev faults`.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace tureen::test {

/// Appends `row` as one line, with `table` as its member "table", to the file in TUREEN_MEASURED.
/// Without that variable, it does nothing. Fails the running test if the file cannot be written.
void leave_measured(const std::string& table, nlohmann::json row);

}  // namespace tureen::test
