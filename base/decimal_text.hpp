// Numbers in sentences, with a decimal point in every locale.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace tureen {

/// `digits` significant digits, 1..9, without trailing zeros: "0.75", "1.2e-05".
std::string short_decimal(double value, int digits);

/// `places` digits after the point, 0..9: "0.50".
std::string fixed_decimal(double value, int places);

/// "33,417".
std::string counted(std::uint64_t number);

/// "1 step", "33,417 steps". `noun`: the singular of a noun with a regular plural.
std::string counted(std::uint64_t number, std::string_view noun);

/// "7 s", "3 min 20 s", "2 h 5 min".
std::string duration_text(double seconds);

}  // namespace tureen
