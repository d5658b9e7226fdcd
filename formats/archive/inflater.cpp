#include "formats/archive/inflater.hpp"

#include <algorithm>
#include <new>

namespace tureen {

Inflater::Inflater(Input& input, Wrapper wrapper, std::uint64_t packed)
    : input_(input),
      packed_(packed),
      // zlib selects the wrapper by the sign and by 16.
      status_(inflateInit2(&stream_, wrapper == Wrapper::none ? -MAX_WBITS : 16 + MAX_WBITS)) {
  if (status_ != Z_OK) throw std::bad_alloc();
}

Inflater::~Inflater() { inflateEnd(&stream_); }

std::size_t Inflater::read(std::span<std::byte> out) {
  const std::size_t wanted = out.size();
  while (!out.empty() && status_ == Z_OK) {
    if (stream_.avail_in == 0 && packed_ > 0) {
      const auto chunk = std::span(source_).first(
          static_cast<std::size_t>(std::min<std::uint64_t>(packed_, source_.size())));
      input_.read(chunk, "deflated data");
      packed_ -= chunk.size();
      stream_.next_in = reinterpret_cast<Bytef*>(chunk.data());
      stream_.avail_in = static_cast<uInt>(chunk.size());
    }
    // zlib counts in 32 bits: at most a gibibyte at a time.
    const auto target = out.first(std::min(out.size(), std::size_t(1) << 30));
    stream_.next_out = reinterpret_cast<Bytef*>(target.data());
    stream_.avail_out = static_cast<uInt>(target.size());
    status_ = ::inflate(&stream_, Z_NO_FLUSH);
    out = out.subspan(target.size() - stream_.avail_out);
  }
  return wanted - out.size();
}

}  // namespace tureen
