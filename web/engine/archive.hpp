// Converts values to bytes and back, for messages between two instances of the same program. The
// format has no version and no fixed byte order, and the reader trusts the bytes.
#pragma once

#include <cassert>
#include <cstddef>
#include <cstring>
#include <map>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

namespace tureen::web {

class ArchiveWriter {
 public:
  template <class... T>
  void operator()(const T&... values) {
    (put(values), ...);
  }
  std::vector<std::byte> take() { return std::move(bytes_); }

 private:
  template <class T>
  void put(const T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    append(&value, sizeof value);
  }
  template <class T>
  void put(const std::vector<T>& values) {
    put(values.size());
    if constexpr (std::is_trivially_copyable_v<T>)
      append(values.data(), values.size() * sizeof(T));
    else
      for (const T& value : values) put(value);
  }
  template <class T>
  void put(std::span<const T> values) {
    static_assert(std::is_trivially_copyable_v<T>);
    put(values.size());
    append(values.data(), values.size_bytes());
  }
  void put(const std::string& text) {
    put(text.size());
    append(text.data(), text.size());
  }
  void put(const std::map<std::string, std::string>& entries) {
    put(entries.size());
    for (const auto& [key, value] : entries) (*this)(key, value);
  }
  void append(const void* data, std::size_t size) {
    const auto* bytes = static_cast<const std::byte*>(data);
    bytes_.insert(bytes_.end(), bytes, bytes + size);
  }

  std::vector<std::byte> bytes_;
};

class ArchiveReader {
 public:
  explicit ArchiveReader(std::span<const std::byte> bytes) : bytes_(bytes) {}

  template <class... T>
  void operator()(T&... values) {
    (get(values), ...);
  }

 private:
  template <class T>
  void get(T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    extract(&value, sizeof value);
  }
  template <class T>
  void get(std::vector<T>& values) {
    values.resize(size());
    if constexpr (std::is_trivially_copyable_v<T>)
      extract(values.data(), values.size() * sizeof(T));
    else
      for (T& value : values) get(value);
  }
  void get(std::string& text) {
    text.resize(size());
    extract(text.data(), text.size());
  }
  void get(std::map<std::string, std::string>& entries) {
    entries.clear();
    for (std::size_t left = size(); left > 0; --left) {
      std::string key, value;
      (*this)(key, value);
      entries.emplace(std::move(key), std::move(value));
    }
  }
  std::size_t size() {
    std::size_t count = 0;
    get(count);
    return count;
  }
  void extract(void* data, std::size_t size) {
    assert(size <= bytes_.size());
    if (size == 0) return;  // data of an empty vector may be null, which memcpy does not allow
    std::memcpy(data, bytes_.data(), size);
    bytes_ = bytes_.subspan(size);
  }

  std::span<const std::byte> bytes_;
};

}  // namespace tureen::web
