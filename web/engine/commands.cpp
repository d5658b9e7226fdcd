#include "web/engine/commands.hpp"

#include <emscripten.h>

#include <new>

#include "base/error.hpp"
#include "web/engine/splat_sorting.hpp"

namespace tureen::web {

// clang-format off
EM_JS(void, tureen_report_progress, (double fraction), {
  if (Module.onProgress) Module.onProgress(fraction);
})
EM_JS(void, tureen_pull_block, (int blob, double offset, void* out, int size), {
  HEAPU8.set(new Uint8Array(Module.blobs[blob], offset, size), out);
})
// clang-format on

std::vector<std::byte>& buffer() {
  static std::vector<std::byte> bytes;
  return bytes;
}

void report_progress(double fraction) { tureen_report_progress(fraction); }

void pull_block(std::size_t blob, std::uint64_t offset, std::span<std::byte> out) {
  tureen_pull_block(int(blob), double(offset), out.data(), int(out.size()));
}

namespace {

constexpr const char* no_memory = "the page has not enough memory for this scene";

/// JSON for the next command. JavaScript writes it here: Emscripten's own strings go to the stack,
/// which is too small for a scene with many cameras.
std::string& arguments() {
  static std::string text;
  return text;
}

Commands all_commands() {
  Commands commands = loader_commands();
  commands.merge(viewer_commands());
  commands.merge(bench_commands());
  commands.merge(sorting_commands());
  return commands;
}

Json failure(const char* kind, const std::string& message) {
  return object({{"error", object({{"kind", kind}, {"message", message}})}});
}

/// Converts every error to a value: JavaScript would get an exception only as a number.
Json run(const std::string& name, const std::string& given) {
  static const Commands commands = all_commands();
  try {
    return object({{"result", commands.at(name)(Json::parse(given))}});
  } catch (const InputError& error) {
    return failure("input", error.without_hint());
  } catch (const UsageError& error) {
    return failure("usage", error.without_hint());
  } catch (const DeviceLimitError& error) {
    return failure("memory", error.without_hint());
  } catch (const Error& error) {
    return failure("device", error.without_hint());
  } catch (const std::bad_alloc&) {
    return failure("memory", no_memory);
  } catch (const std::exception& error) {
    return failure("usage", name + ": " + error.what());
  }
}

}  // namespace

extern "C" {

/// Allocates `size` bytes of UTF-8 JSON for the next command. Returns null if the memory is full.
EMSCRIPTEN_KEEPALIVE char* tureen_arguments(int size) {
  try {
    arguments().resize(std::size_t(size));
  } catch (const std::bad_alloc&) {
    return nullptr;
  }
  return arguments().data();
}

/// Returns {"result": ..} or {"error": {"kind", "message"}}, valid until the next call.
EMSCRIPTEN_KEEPALIVE const char* tureen_call(const char* name) {
  static std::string answer;
  try {
    // Names in files may not be UTF-8.
    answer = run(name, arguments()).dump(-1, ' ', false, Json::error_handler_t::replace);
  } catch (const std::bad_alloc&) {
    answer = failure("memory", no_memory).dump();
  }
  return answer.c_str();
}

/// Resizes buffer() and returns its address, or null if the memory is full. A negative size does
/// not change it.
EMSCRIPTEN_KEEPALIVE void* tureen_buffer(int size) {
  try {
    if (size >= 0) buffer().resize(std::size_t(size));
  } catch (const std::bad_alloc&) {
    return nullptr;
  }
  return buffer().data();
}

EMSCRIPTEN_KEEPALIVE int tureen_buffer_size() { return int(buffer().size()); }
}

}  // namespace tureen::web
