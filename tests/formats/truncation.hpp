// Decoders on damaged bytes: cut at every length, and with every byte damaged.
// Use:  EXPECT_EQ(survive_truncation(bytes, read).read, 0u);  EXPECT_GT(.. .refused, 0u);
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <exception>
#include <span>
#include <string>
#include <vector>

#include "base/error.hpp"

namespace tureen::test {

/// Outcomes of the damaged inputs. Every other outcome fails the test.
struct Survival {
  std::size_t read = 0;     // accepted; `read` may check the result
  std::size_t refused = 0;  // an InputError with a reason
};

/// Calls `read(std::span<const std::byte>)` once and counts the outcome. A crash fails the test,
/// and so does any exception except an InputError with a file and a reason.
template <class Read>
void expect_survival(std::span<const std::byte> bytes, Read&& read, const std::string& damage,
                     Survival& survival) {
  // A copy of exactly this size, so that a sanitizer sees a read past the end.
  const std::vector<std::byte> copy(bytes.begin(), bytes.end());
  try {
    read(std::span<const std::byte>(copy));
    ++survival.read;
  } catch (const InputError& error) {
    ++survival.refused;
    EXPECT_FALSE(error.reason().empty()) << damage;
    EXPECT_FALSE(error.position().file.empty()) << damage << ": " << error.what();
  } catch (const std::exception& error) {
    ADD_FAILURE() << damage << " threw something other than an InputError: " << error.what();
  }
}

/// Reads the first 0, 1, .. size - 1 bytes.
template <class Read>
void survive_truncation(std::span<const std::byte> bytes, Read&& read, Survival& survival) {
  for (std::size_t length = 0; length < bytes.size(); ++length)
    expect_survival(bytes.first(length), read, "cut to " + std::to_string(length) + " bytes",
                    survival);
}

template <class Read>
Survival survive_truncation(std::span<const std::byte> bytes, Read&& read) {
  Survival survival;
  survive_truncation(bytes, read, survival);
  return survival;
}

/// How a byte is damaged: in every way of survive_damage(), or in one of them, by its position.
enum class Damage { every, one };

/// Reads `bytes` with each byte damaged in turn: each single bit flipped, all bits flipped, 0,
/// 0x7f.
template <class Read>
Survival survive_damage(std::span<const std::byte> bytes, Read&& read,
                        Damage damage = Damage::every) {
  Survival survival;
  std::vector<std::byte> damaged(bytes.begin(), bytes.end());
  for (std::size_t i = 0; i < damaged.size(); ++i) {
    const auto original = std::to_integer<unsigned>(damaged[i]);
    std::array<unsigned, 11> values{original ^ 0xffu, 0u, 0x7fu};
    for (unsigned bit = 0; bit < 8; ++bit) values[3 + bit] = original ^ (1u << bit);
    for (std::size_t k = 0; k < values.size(); ++k) {
      const unsigned value = values[k];
      if (value == original || (damage == Damage::one && k != i % values.size())) continue;
      damaged[i] = static_cast<std::byte>(value);
      expect_survival(damaged, read,
                      "byte " + std::to_string(i) + " set to " + std::to_string(value), survival);
    }
    damaged[i] = static_cast<std::byte>(original);
  }
  return survival;
}

}  // namespace tureen::test
