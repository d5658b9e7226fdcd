// Small torch files for tests: pickles opcode by opcode, zip archives byte by byte. They were
// compared with files by torch 1.13 by hand.
#pragma once

#include <zlib.h>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace tureen::test {

inline void append_little(std::string& out, std::uint64_t value, int bytes) {
  for (int i = 0; i < bytes; ++i) out += static_cast<char>(i < 8 ? value >> (8 * i) & 0xff : 0);
}

inline std::span<const std::byte> as_bytes(const std::string& text) {
  return std::as_bytes(std::span(text));
}

// ---- zip

struct ZipFixture {
  struct Entry {
    std::string name, content;
    bool deflate = false;
  };
  std::vector<Entry> entries;
  bool zip64 = false;

  std::string bytes() const {
    std::string out, directory;
    for (const Entry& entry : entries) {
      const std::string packed = entry.deflate ? deflated(entry.content) : entry.content;
      const auto at = out.size();
      append_little(out, 0x04034b50, 4);
      append_little(out, 20, 2);
      append_little(out, 0, 2);
      append_little(out, entry.deflate ? 8 : 0, 2);
      append_little(out, 0, 8);  // time, date, checksum
      append_little(out, packed.size(), 4);
      append_little(out, entry.content.size(), 4);
      append_little(out, entry.name.size(), 2);
      append_little(out, 5, 2);  // torch pads only here
      out += entry.name + std::string("FB\1\0Z", 5);
      out += packed;

      append_little(directory, 0x02014b50, 4);
      append_little(directory, 20, 2);
      append_little(directory, 20, 2);
      append_little(directory, 0, 2);
      append_little(directory, entry.deflate ? 8 : 0, 2);
      append_little(directory, 0, 8);
      append_little(directory, zip64 ? 0xffffffff : packed.size(), 4);
      append_little(directory, zip64 ? 0xffffffff : entry.content.size(), 4);
      append_little(directory, entry.name.size(), 2);
      append_little(directory, zip64 ? 28 : 0, 2);
      append_little(directory, 0, 10);  // comment, disk, attributes
      append_little(directory, zip64 ? 0xffffffff : at, 4);
      directory += entry.name;
      if (zip64) {
        append_little(directory, 1, 2);
        append_little(directory, 24, 2);
        append_little(directory, entry.content.size(), 8);
        append_little(directory, packed.size(), 8);
        append_little(directory, at, 8);
      }
    }
    const auto start = out.size();
    out += directory;
    if (zip64) {
      const auto end64 = out.size();
      append_little(out, 0x06064b50, 4);
      append_little(out, 44, 8);
      append_little(out, 45, 2);
      append_little(out, 45, 2);
      append_little(out, 0, 8);
      append_little(out, entries.size(), 8);
      append_little(out, entries.size(), 8);
      append_little(out, directory.size(), 8);
      append_little(out, start, 8);
      append_little(out, 0x07064b50, 4);
      append_little(out, 0, 4);
      append_little(out, end64, 8);
      append_little(out, 1, 4);
    }
    append_little(out, 0x06054b50, 4);
    append_little(out, 0, 4);
    append_little(out, zip64 ? 0xffff : entries.size(), 2);
    append_little(out, zip64 ? 0xffff : entries.size(), 2);
    append_little(out, zip64 ? 0xffffffff : directory.size(), 4);
    append_little(out, zip64 ? 0xffffffff : start, 4);
    append_little(out, 0, 2);
    return out;
  }

  static std::string deflated(const std::string& content) {
    z_stream stream{};
    if (deflateInit2(&stream, 9, Z_DEFLATED, -MAX_WBITS, 8, Z_DEFAULT_STRATEGY) != Z_OK)
      throw std::runtime_error("deflateInit2");
    std::string packed(deflateBound(&stream, static_cast<uLong>(content.size())), '\0');
    std::string source = content;
    stream.next_in = reinterpret_cast<Bytef*>(source.data());
    stream.avail_in = static_cast<uInt>(source.size());
    stream.next_out = reinterpret_cast<Bytef*>(packed.data());
    stream.avail_out = static_cast<uInt>(packed.size());
    deflate(&stream, Z_FINISH);
    packed.resize(stream.total_out);
    deflateEnd(&stream);
    return packed;
  }
};

// ---- pickle

/// Appends the output of Python's pickler with protocol 2, without the memo.
struct PickleFixture {
  std::string out = "\x80\x02";

  PickleFixture& op(std::string_view bytes) {
    out += bytes;
    return *this;
  }
  PickleFixture& text(std::string_view value) {
    out += 'X';
    append_little(out, value.size(), 4);
    out += value;
    return *this;
  }
  PickleFixture& integer(std::int32_t value) {
    out += 'J';
    append_little(out, static_cast<std::uint32_t>(value), 4);
    return *this;
  }
  PickleFixture& real(double value) {
    std::uint64_t bits;
    std::memcpy(&bits, &value, sizeof bits);
    out += 'G';
    for (int i = 7; i >= 0; --i) out += static_cast<char>(bits >> (8 * i) & 0xff);
    return *this;
  }
  PickleFixture& global(std::string_view module, std::string_view name) {
    out += 'c';
    out += module;
    out += '\n';
    out += name;
    out += '\n';
    return *this;
  }
  /// An integer that may exceed 32 bits: LONG1, as Python writes it.
  PickleFixture& whole(std::uint64_t value) {
    if (value < 1u << 31) return integer(static_cast<std::int32_t>(value));
    const int bytes = value >> 63 ? 9 : 8;  // the top bit is the sign
    op("\x8a").op(std::string(1, static_cast<char>(bytes)));
    append_little(out, value, bytes);
    return *this;
  }
  PickleFixture& integers(const std::vector<std::uint64_t>& values) {
    op("(");
    for (const std::uint64_t value : values) whole(value);
    return op("t");
  }
  std::string done() const { return out + '.'; }
};

// ---- torch

struct TensorFixture {
  std::string type = "FloatStorage";
  std::string storage;  // raw bytes
  std::size_t element = 4;
  std::vector<std::uint64_t> shape;
  std::vector<std::uint64_t> strides{};  // empty: row-major
  std::uint64_t offset = 0;
  std::optional<std::uint64_t> stored{};  // stated number of elements; nullopt: the true one
  bool parameter = false;

  template <class T>
  static TensorFixture of(const char* type, std::vector<std::uint64_t> shape,
                          const std::vector<T>& values) {
    TensorFixture tensor;
    tensor.type = type;
    tensor.element = sizeof(T);
    tensor.shape = std::move(shape);
    tensor.storage.assign(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
    return tensor;
  }
  static TensorFixture floats(std::vector<std::uint64_t> shape, const std::vector<float>& values) {
    return of("FloatStorage", std::move(shape), values);
  }
  static TensorFixture ints(std::vector<std::uint64_t> shape,
                            const std::vector<std::int32_t>& values) {
    return of("IntStorage", std::move(shape), values);
  }
};

/// A dict with tensors, numbers and one nested dict, in the format of torch.save.
class TorchFixture {
 public:
  bool deflate = false;
  bool zip64 = false;

  TorchFixture() { pickle_.op("}("); }

  TorchFixture& add(std::string_view key, const TensorFixture& tensor) {
    pickle_.text(key);
    write(tensor);
    return *this;
  }
  TorchFixture& add(std::string_view key, std::int32_t value) {
    pickle_.text(key).integer(value);
    return *this;
  }
  TorchFixture& add(std::string_view key, double value) {
    pickle_.text(key).real(value);
    return *this;
  }
  /// An OrderedDict with attributes, as state_dict() returns it.
  TorchFixture& add(std::string_view key,
                    const std::vector<std::pair<std::string, TensorFixture>>& state) {
    pickle_.text(key).global("collections", "OrderedDict").op(")R(");
    for (const auto& [name, tensor] : state) {
      pickle_.text(name);
      write(tensor);
    }
    pickle_.op("u}(").text("_metadata").op("}ub");
    return *this;
  }

  std::string bytes() const {
    ZipFixture zip;
    zip.zip64 = zip64;
    zip.entries.push_back({"archive/data.pkl", pickle_.out + "u.", deflate});
    for (std::size_t i = 0; i < storages_.size(); ++i)
      zip.entries.push_back({"archive/data/" + std::to_string(i), storages_[i], deflate});
    zip.entries.push_back({"archive/version", "3\n", false});
    return zip.bytes();
  }

 private:
  void write(const TensorFixture& tensor) {
    std::vector<std::uint64_t> strides = tensor.strides;
    if (strides.empty()) {
      strides.resize(tensor.shape.size());
      std::uint64_t stride = 1;
      for (std::size_t d = strides.size(); d-- > 0; stride *= tensor.shape[d]) strides[d] = stride;
    }
    if (tensor.parameter) pickle_.global("torch._utils", "_rebuild_parameter").op("(");
    pickle_.global("torch._utils", "_rebuild_tensor_v2").op("((");
    pickle_.text("storage").global("torch", tensor.type).text(std::to_string(storages_.size()));
    pickle_.text("cpu").whole(tensor.stored.value_or(tensor.storage.size() / tensor.element));
    pickle_.op("tQ").whole(tensor.offset);
    pickle_.integers(tensor.shape).integers(strides);
    pickle_.op("\x89").global("collections", "OrderedDict").op(")RtR");
    if (tensor.parameter) pickle_.op("\x88").global("collections", "OrderedDict").op(")RtR");
    storages_.push_back(tensor.storage);
  }

  PickleFixture pickle_;
  std::vector<std::string> storages_;
};

}  // namespace tureen::test
