// Runs the kernels of the CUDA backend on the processor, one thread after another. Finds errors in
// their mathematics, memory or phases without a GPU.
//
// Blocks and the threads of a phase run in one of two orders. Kernels without data races return the
// same bits in both. Shared memory is initialised with NaNs, because the device's is uninitialised.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <new>
#include <string>
#include <type_traits>
#include <vector>

#include "trainer/common/cuda/kernel.hpp"

namespace tureen::trainer::test {

/// Threads run one after another, so plain operations are atomic.
struct HostAtomics {
  static unsigned long long load(const unsigned long long& value) { return value; }
  static unsigned load(const unsigned& value) { return value; }
  static void add(unsigned long long& value, unsigned long long addend) { value += addend; }
  static void maximum(unsigned long long& value, unsigned long long other) {
    value = std::max(value, other);
  }
  static void set_bits(unsigned& value, unsigned bits) { value |= bits; }
};

template <bool backwards>
class HostMachine {
 public:
  std::string description() const { return "the processor in place of a GPU"; }
  void* allocate(std::size_t bytes) {
    void* memory = std::malloc(bytes);
    if (!memory) throw std::bad_alloc();
    std::memset(memory, 0xff, bytes);
    return memory;
  }
  void release(void* memory) { std::free(memory); }
  void clear(void* memory, std::size_t bytes) { std::memset(memory, 0, bytes); }
  void upload(void* to, const void* from, std::size_t bytes) { std::memcpy(to, from, bytes); }
  void download(void* to, const void* from, std::size_t bytes) { std::memcpy(to, from, bytes); }
  unsigned resident_blocks() const { return 3; }  // few, so that each block processes many pieces
  void mark(int number) { marks_[number] = std::chrono::steady_clock::now(); }
  double seconds(int from, int to) {
    return std::chrono::duration<double>(marks_[to] - marks_[from]).count();
  }

  template <class Kernel>
  void launch(const Kernel& kernel, std::size_t blocks) {
    using Shared = typename Kernel::Shared;
    static_assert(std::is_trivially_copyable_v<Kernel> && std::is_trivial_v<Shared> &&
                  std::is_trivial_v<typename Kernel::Local>);
    static_assert(sizeof(Shared) <= 48 * 1024, "a block of any GPU has 48 KiB by default");
    const auto shared = std::make_unique<Shared>();
    std::vector<typename Kernel::Local> locals(Kernel::threads);
    for (std::size_t i = 0; i < blocks; ++i) {
      const auto block = unsigned(backwards ? blocks - 1 - i : i);
      std::memset(static_cast<void*>(shared.get()), 0xff, sizeof(Shared));
      std::fill(locals.begin(), locals.end(), typename Kernel::Local{});
      for (unsigned phase = 0; phase < kernel.phases(); ++phase)
        for (unsigned j = 0; j < Kernel::threads; ++j) {
          const unsigned thread = backwards ? Kernel::threads - 1 - j : j;
          kernel.template run<HostAtomics>(phase, {block, thread, unsigned(blocks)}, *shared,
                                           locals[thread]);
        }
    }
  }

 private:
  std::chrono::steady_clock::time_point marks_[6];
};

}  // namespace tureen::trainer::test
