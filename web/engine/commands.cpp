#include "web/engine/commands.hpp"

#include <emscripten.h>

#include <memory>
#include <new>

#include "base/error.hpp"
#include "web/engine/engine.hpp"

namespace tureen::web {

// clang-format off
EM_JS(void, tureen_report_progress, (double fraction), {
  if (Module.onProgress) Module.onProgress(fraction);
})
EM_JS(void, tureen_pull_block, (int blob, double offset, void* out, int size), {
  HEAPU8.set(new Uint8Array(Module.blobs[blob], offset, size), out);
})
// clang-format on

void report_progress(double fraction) { tureen_report_progress(fraction); }

void pull_block(std::size_t blob, std::uint64_t offset, std::span<std::byte> out) {
  tureen_pull_block(int(blob), double(offset), out.data(), int(out.size()));
}

namespace {

constexpr const char* no_memory = "the page has not enough memory for this scene";

Commands all_commands() {
  Commands commands = loader_commands();
  commands.merge(viewer_commands());
  commands.merge(bench_commands());
  commands.merge(exchange_commands());
  commands.merge(sorting_commands());
  return commands;
}

Json failure(const char* kind, const std::string& message) {
  return object({{"error", object({{"kind", kind}, {"message", message}})}});
}

/// Converts every error to a value: JavaScript would get an exception only as a number.
Json run(Engine& engine, const std::string& name) {
  try {
    const Command& command = engine.commands.at(name);
    return object({{"result", command(engine, Json::parse(engine.arguments))}});
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

/// The engine of this instance, which JavaScript passes to all other functions. It is never freed.
EMSCRIPTEN_KEEPALIVE Engine* tureen_engine() {
  auto engine = std::make_unique<Engine>();
  engine->commands = all_commands();
  return engine.release();
}

/// Allocates `size` bytes of UTF-8 JSON for the next command. Returns null if the memory is full.
EMSCRIPTEN_KEEPALIVE char* tureen_arguments(Engine* engine, int size) {
  try {
    engine->arguments.resize(std::size_t(size));
  } catch (const std::bad_alloc&) {
    return nullptr;
  }
  return engine->arguments.data();
}

/// Returns {"result": ..} or {"error": {"kind", "message"}}, valid until the next call.
EMSCRIPTEN_KEEPALIVE const char* tureen_call(Engine* engine, const char* name) {
  std::string& answer = engine->answer;
  try {
    // Names in files may not be UTF-8.
    answer = run(*engine, name).dump(-1, ' ', false, Json::error_handler_t::replace);
  } catch (const std::bad_alloc&) {
    answer = failure("memory", no_memory).dump();
  }
  return answer.c_str();
}

/// Resizes the buffer and returns its address, or null if the memory is full. A negative size does
/// not change it.
EMSCRIPTEN_KEEPALIVE void* tureen_buffer(Engine* engine, int size) {
  try {
    if (size >= 0) engine->buffer.resize(std::size_t(size));
  } catch (const std::bad_alloc&) {
    return nullptr;
  }
  return engine->buffer.data();
}

EMSCRIPTEN_KEEPALIVE int tureen_buffer_size(Engine* engine) { return int(engine->buffer.size()); }
}

}  // namespace tureen::web
