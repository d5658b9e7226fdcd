// The Machine of trainer/diffsoup/cuda/kernel_backend.hpp on a GPU. It uses the default stream of
// the current device, and memory from the driver.
#pragma once

#include <cuda_runtime.h>

#include <cstddef>
#include <string>

#include "base/error.hpp"
#include "trainer/common/cuda/kernel.hpp"

namespace tureen::trainer::cuda {

/// Throws DeviceLimitError if the GPU's memory is full, and ContextError for other failures.
/// `doing`: the failed action, for the message "the GPU could not ..".
void check(cudaError_t result, const char* doing);

struct CudaAtomics {
  /// Reads a value that another thread may be changing.
  template <class Number>
  __device__ static Number load(const Number& value) {
    return *static_cast<const volatile Number*>(&value);
  }
  __device__ static void add(unsigned long long& value, unsigned long long addend) {
    atomicAdd(&value, addend);
  }
  __device__ static void maximum(unsigned long long& value, unsigned long long other) {
    atomicMax(&value, other);
  }
  __device__ static void set_bits(unsigned& value, unsigned bits) { atomicOr(&value, bits); }
};

template <class Kernel>
__global__ void __launch_bounds__(Kernel::threads) run_kernel(const Kernel kernel) {
  __shared__ typename Kernel::Shared shared;
  typename Kernel::Local local{};
  const Thread at{blockIdx.x, threadIdx.x, gridDim.x};
  const unsigned phases = kernel.phases();
  for (unsigned phase = 0; phase < phases; ++phase) {
    if (phase > 0) __syncthreads();
    kernel.template run<CudaAtomics>(phase, at, shared, local);
  }
}

class CudaMachine {
 public:
  /// Throws ContextError if no GPU is available.
  CudaMachine();
  CudaMachine(const CudaMachine&) = delete;
  CudaMachine& operator=(const CudaMachine&) = delete;
  ~CudaMachine();

  std::string description() const { return name_; }
  void* allocate(std::size_t bytes);
  void release(void* memory);
  void clear(void* memory, std::size_t bytes);
  void upload(void* to, const void* from, std::size_t bytes);
  void download(void* to, const void* from, std::size_t bytes);
  unsigned resident_blocks() const { return resident_blocks_; }
  void mark(int number);
  double seconds(int from, int to);

  template <class Kernel>
  void launch(const Kernel& kernel, std::size_t blocks) {
    if (blocks == 0) return;  // no faces are left; CUDA rejects empty launches
    run_kernel<<<unsigned(blocks), Kernel::threads>>>(kernel);
    check(cudaGetLastError(), "start a kernel");
  }

 private:
  std::string name_;
  unsigned resident_blocks_ = 0;
  cudaEvent_t marks_[6] = {};
};

}  // namespace tureen::trainer::cuda
