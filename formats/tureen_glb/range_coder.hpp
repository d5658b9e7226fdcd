// A binary range coder with adaptive probabilities: a bit of probability p costs -log2(p) bits in
// the file (G. N. N. Martin, Range encoding, 1979; carries are handled as in 7-Zip's LZMA).
//
// Encoder and decoder have the same `bit` function. The encoder codes its argument; the decoder
// ignores the argument; both return the bit. One traversal of the data therefore serves both
// directions. The decoder accepts any bytes: past their end it reads zeros, and exhausted() returns
// true.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace tureen {

/// Probability that the next bit is 0: the mean of a fast and a slow estimate, 16 bits each. The
/// fast one follows changes, the slow one is accurate in the long run. Both begin as the mean of
/// the bits so far plus half a bit of either value, so that rarely used models adapt quickly.
class BitModel {
 public:
  // Not constexpr: compilers would evaluate arrays of thousands of models one by one.
  BitModel() : quick_(32768), slow_(32768) {}

  /// In 1..4095 of 4096, so that both bits are always possible.
  std::uint32_t probability_of_zero() const {
    const std::uint32_t mean = (std::uint32_t(quick_) + slow_) >> 5;
    return mean < 1 ? 1 : mean > 4095 ? 4095 : mean;
  }
  void update(int bit) {
    quick_ = moved(quick_, bit, 16);
    slow_ = moved(slow_, bit, slow_pace);
    if (bits_ < slow_pace) ++bits_;
  }

 private:
  static constexpr int slow_pace = 128;

  /// The estimate after a bit with weight 1/`pace`, or 1 / (bits so far + 1.5) if that is larger.
  /// Quotients are truncated towards zero: all decoders must agree.
  std::uint16_t moved(int estimate, int bit, int pace) const {
    const int by = (bit ? 0 : 65535) - estimate, halves = 2 * bits_ + 3;
    return static_cast<std::uint16_t>(estimate + (halves < 2 * pace ? 2 * by / halves : by / pace));
  }

  std::uint16_t quick_, slow_;
  std::uint8_t bits_ = 0;
};

class RangeEncoder {
 public:
  int bit(BitModel& model, int bit) {
    const std::uint32_t bound = (range_ >> 12) * model.probability_of_zero();
    if (bit) {
      low_ += bound;
      range_ -= bound;
    } else {
      range_ = bound;
    }
    model.update(bit);
    while (range_ < (1u << 24)) {
      range_ <<= 8;
      shift();
    }
    return bit;
  }

  /// The bytes; the encoder must not be used afterwards.
  std::vector<std::byte> finish() {
    for (int i = 0; i < 5; ++i) shift();
    return std::move(bytes_);
  }

 private:
  void shift() {
    if (low_ < 0xff000000u || low_ > 0xffffffffu) {
      const auto carry = static_cast<std::uint8_t>(low_ >> 32);
      for (; pending_ > 0; --pending_) {
        bytes_.push_back(static_cast<std::byte>(static_cast<std::uint8_t>(cache_ + carry)));
        cache_ = 0xff;
      }
      cache_ = static_cast<std::uint8_t>(low_ >> 24);
    }
    ++pending_;
    low_ = (low_ & 0x00ffffffu) << 8;
  }

  std::uint64_t low_ = 0;
  std::uint32_t range_ = 0xffffffffu;
  std::uint8_t cache_ = 0;
  std::uint64_t pending_ = 1;
  std::vector<std::byte> bytes_;
};

/// The cost of bits, for an encoder that has a choice. It codes nothing and does not update models.
class BitPrice {
 public:
  int bit(const BitModel& model, int bit) {
    const std::uint32_t zero = model.probability_of_zero();
    bits_ += of(bit ? 4096 - zero : zero);
    return bit;
  }
  double bits() const { return bits_; }

 private:
  /// Cost of an event with probability `of_4096` / 4096; `of_4096` is in 1..4095.
  static double of(std::uint32_t of_4096) {
    static const auto table = [] {
      std::array<double, 4096> result{};
      for (std::size_t i = 1; i < result.size(); ++i) result[i] = 12 - std::log2(double(i));
      return result;
    }();
    return table[of_4096];
  }

  double bits_ = 0;
};

class RangeDecoder {
 public:
  /// The bytes must outlive the decoder.
  explicit RangeDecoder(std::span<const std::byte> bytes) : bytes_(bytes) {
    for (int i = 0; i < 5; ++i) code_ = code_ << 8 | next();
  }

  int bit(BitModel& model, int = 0) {
    const std::uint32_t bound = (range_ >> 12) * model.probability_of_zero();
    const int bit = code_ >= bound ? 1 : 0;
    if (bit) {
      code_ -= bound;
      range_ -= bound;
    } else {
      range_ = bound;
    }
    model.update(bit);
    while (range_ < (1u << 24)) {
      range_ <<= 8;
      code_ = code_ << 8 | next();
    }
    return bit;
  }

  /// Whether reading passed the end: the bytes are truncated or damaged.
  bool exhausted() const { return past_end_ > 0; }

 private:
  std::uint32_t next() {
    if (position_ < bytes_.size()) return std::to_integer<std::uint32_t>(bytes_[position_++]);
    ++past_end_;
    return 0;
  }

  std::span<const std::byte> bytes_;
  std::size_t position_ = 0;
  std::size_t past_end_ = 0;
  std::uint32_t range_ = 0xffffffffu;
  std::uint32_t code_ = 0;
};

/// Codes non-negative integers: their length in bits, then the bits below the leading one. The
/// length and the next two bits have adaptive models by context; the remaining bits share one model
/// a length.
template <int max_length>
class NumberModel {
 public:
  /// `value` in 0..2^max_length - 2. The decoded value is in the same range for any bytes.
  template <class Coder>
  std::uint32_t code(Coder& coder, std::uint32_t value) {
    const std::uint32_t wanted = value + 1;
    int length = 1;
    while (length < max_length) {
      if (!coder.bit(longer_[length], (wanted >> length) != 0)) break;
      ++length;
    }
    std::uint32_t result = 1;
    for (int i = length - 2; i >= 0; --i) {
      const int bit = int(wanted >> i & 1u);
      const int below = length - 2 - i;  // 0 for the bit below the leading one
      BitModel& model = below == 0   ? second_[length]
                        : below == 1 ? third_[length][result & 1u]
                                     : rest_[length];
      result = result << 1 | std::uint32_t(coder.bit(model, bit));
    }
    return result - 1;
  }

 private:
  BitModel longer_[max_length + 1];
  BitModel second_[max_length + 1];
  BitModel third_[max_length + 1][2];
  BitModel rest_[max_length + 1];
};

/// The same for signed integers; the sign is adaptive as well.
template <int max_length>
class SignedModel {
 public:
  template <class Coder>
  int code(Coder& coder, int value) {
    const std::uint32_t size = magnitude_.code(coder, std::uint32_t(value < 0 ? -value : value));
    if (size == 0) return 0;
    return coder.bit(negative_, value < 0) ? -int(size) : int(size);
  }

 private:
  NumberModel<max_length> magnitude_;
  BitModel negative_;
};

}  // namespace tureen
