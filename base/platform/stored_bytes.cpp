#include "base/platform/stored_bytes.hpp"

#include <span>

#include "base/platform/scratch_file.hpp"

namespace tureen {

std::vector<std::uint8_t> StoredBytes::operator()() const {
  if (memory_) return *memory_;
  std::vector<std::uint8_t> bytes(size_);
  if (file_) file_->read(place_, std::as_writable_bytes(std::span(bytes)));
  return bytes;
}

void StoredBytes::move_to(const std::shared_ptr<ScratchFile>& file) {
  if (!memory_) return;
  place_ = file->append(std::as_bytes(std::span(*memory_)));
  file_ = file;
  memory_.reset();
}

void StoredBytes::shorten(std::size_t size) {
  if (size >= size_) return;
  if (memory_)
    memory_ = std::make_shared<const std::vector<std::uint8_t>>(
        memory_->begin(), memory_->begin() + std::ptrdiff_t(size));
  size_ = size;
}

void StoredBytes::expect() const {
  if (file_) file_->expect(place_, size_);
}

}  // namespace tureen
