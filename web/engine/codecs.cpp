// The functions of zlib and zstd that readers call, by libraries in JavaScript
// (web/viewer/codecs.ts): their C libraries are not there for WebAssembly. The program that reads
// compressed formats links them; zlib.h and zstd.h are the system's.
#include <emscripten.h>
#include <zlib.h>
#include <zstd.h>

#include <array>
#include <cstdint>

// clang-format off
EM_JS(int, tureen_inflate_begin, (int window_bits), { return Module.codecs.begin(window_bits); })
// left: receives the number of bytes that are left of input and output.
EM_JS(int, tureen_inflate, (int stream, const void* from, int from_size, void* to, int to_size, int* left), {
  const [status, of_input, of_output] = Module.codecs.inflate(stream, HEAPU8, from, from_size, to, to_size);
  HEAP32[left >> 2] = of_input;
  HEAP32[(left >> 2) + 1] = of_output;
  return status;
})
EM_JS(void, tureen_inflate_end, (int stream), { Module.codecs.end(stream); })
EM_JS(int, tureen_unzstd, (const void* from, int from_size, void* to, int to_size), {
  return Module.codecs.unzstd(HEAPU8.subarray(from, from + from_size), HEAPU8.subarray(to, to + to_size));
})
// clang-format on

extern "C" {

/// z_stream::state is the number of the stream.
int inflateInit2_(z_streamp stream, int window_bits, const char*, int) {
  const auto number = std::uintptr_t(tureen_inflate_begin(window_bits));
  stream->state = reinterpret_cast<internal_state*>(number);
  return Z_OK;
}

int inflate(z_streamp stream, int) {
  std::array<int, 2> left{};
  const int status =
      tureen_inflate(int(reinterpret_cast<std::uintptr_t>(stream->state)), stream->next_in,
                     int(stream->avail_in), stream->next_out, int(stream->avail_out), left.data());
  stream->next_in += stream->avail_in - uInt(left[0]);
  stream->next_out += stream->avail_out - uInt(left[1]);
  stream->avail_in = uInt(left[0]);
  stream->avail_out = uInt(left[1]);
  return status;
}

int inflateEnd(z_streamp stream) {
  tureen_inflate_end(int(reinterpret_cast<std::uintptr_t>(stream->state)));
  return Z_OK;
}

/// Damaged data: a number that is no size.
std::size_t ZSTD_decompress(void* out, std::size_t out_size, const void* in, std::size_t in_size) {
  return std::size_t(tureen_unzstd(in, int(in_size), out, int(out_size)));
}
}
