#include "trainer/common/checkpoint_file.hpp"

#include <fmt/format.h>
#include <zlib.h>

namespace tureen::trainer {

namespace {

template <class Archive, class View>
void visit_view(Archive& archive, View& view) {
  auto& [name, width, height, camera, pixels] = view;
  archive(name, "the name of a view");
  archive(width, "the width of a view");
  archive(height, "the height of a view");
  archive(camera, "the checksum of a camera");
  archive(pixels, "the checksum of a photograph");
}

}  // namespace

std::uint32_t checksum(std::uint32_t sum, std::span<const std::byte> bytes) {
  if (bytes.empty()) return sum;  // for a null pointer zlib returns the initial sum
  return std::uint32_t(crc32_z(sum, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

void CheckpointWriter::bytes(std::span<const std::byte> bytes) {
  sum_ = checksum(sum_, bytes);
  output_.write(bytes);
}

void CheckpointWriter::finish() {
  output_.write_value(sum_);
  output_.commit();
}

void CheckpointReader::operator()(std::string& text, const char* what) {
  const std::vector<char> letters = input_.read_values<char>(count(what), what);
  sum_ = checksum(sum_, std::as_bytes(std::span(letters)));
  text.assign(letters.begin(), letters.end());
}

std::uint64_t CheckpointReader::count(const char* what) {
  std::uint64_t value = 0;
  (*this)(value, what);
  return value;
}

void CheckpointReader::finish() {
  if (input_.read_value<std::uint32_t>("the checksum") != sum_)
    input_.fail_at(0, "the file is damaged: its checksum does not match its bytes");
  if (input_.remaining() > 0) input_.fail("the file has bytes after the end of the checkpoint");
}

void write_head(CheckpointWriter& writer, const CheckpointKind& kind, const CheckpointHead& head) {
  writer(kind.magic, "");
  writer(kind.version, "");
  writer(head.config, "");
  writer(std::uint64_t(head.views.size()), "");
  for (const ViewFingerprint& view : head.views) visit_view(writer, view);
  writer(head.seconds, "");
}

CheckpointHead read_head(CheckpointReader& reader, const CheckpointKind& kind) {
  const Input& input = reader.input();
  CheckpointMagic magic{};
  reader(magic, "the file's kind");
  if (magic != kind.magic) input.fail_at(0, "this is not a checkpoint of tureen train");
  std::uint32_t version = 0;
  reader(version, "the version");
  if (version != kind.version)
    input.fail_at(magic.size(), fmt::format("checkpoint version {} is not supported; this build "
                                            "reads version {}",
                                            version, kind.version));
  CheckpointHead head;
  reader(head.config, "the configuration");
  std::uint64_t views = 0;
  reader(views, "the number of views");
  // Appended one by one: a wrong count then allocates no memory.
  for (std::uint64_t i = 0; i < views; ++i) visit_view(reader, head.views.emplace_back());
  reader(head.seconds, "the seconds so far");
  return head;
}

}  // namespace tureen::trainer
