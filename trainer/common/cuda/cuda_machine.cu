#include "trainer/common/cuda/cuda_machine.cuh"

namespace tureen::trainer::cuda {

namespace {

__global__ void do_nothing() {}

std::string sentence(cudaError_t error) {
  return std::string(cudaGetErrorName(error)) + ": " + cudaGetErrorString(error);
}

}  // namespace

void check(cudaError_t result, const char* doing) {
  if (result == cudaSuccess) return;
  (void)cudaGetLastError();  // clears the pending error, which is thrown below
  const std::string reason =
      std::string("the GPU could not ") + doing + " (" + sentence(result) + ")";
  if (result == cudaErrorMemoryAllocation)
    throw DeviceLimitError(reason + ": use fewer or smaller images, or --device cpu");
  throw ContextError(reason);
}

CudaMachine::CudaMachine() {
  int count = 0;  // cudaGetDeviceCount does not set it without a driver
  cudaError_t result = cudaGetDeviceCount(&count);
  if (result == cudaSuccess && count == 0) result = cudaErrorNoDevice;
  if (result != cudaSuccess) {
    (void)cudaGetLastError();
    throw ContextError("no GPU is available (" + sentence(result) + "): use --device cpu");
  }
  int device = 0;
  check(cudaGetDevice(&device), "be selected");
  cudaDeviceProp properties{};
  check(cudaGetDeviceProperties(&properties, device), "report its properties");
  name_ = properties.name;
  // Kernels for another GPU generation fail only at launch. This check reports the error earlier.
  cudaFuncAttributes attributes;
  check(cudaFuncGetAttributes(&attributes, do_nothing), "run the kernels of this build");
  // A multiprocessor holds at most 2,048 threads: 16 blocks of 128 threads, or 8 blocks of 256.
  resident_blocks_ = 16 * unsigned(properties.multiProcessorCount);
  for (cudaEvent_t& mark : marks_) check(cudaEventCreate(&mark), "measure time");
}

CudaMachine::~CudaMachine() {
  for (cudaEvent_t mark : marks_)
    if (mark) cudaEventDestroy(mark);
}

void* CudaMachine::allocate(std::size_t bytes) {
  void* memory = nullptr;
  check(cudaMalloc(&memory, bytes), "allocate memory");
  return memory;
}

void CudaMachine::release(void* memory) { cudaFree(memory); }

void CudaMachine::clear(void* memory, std::size_t bytes) {
  check(cudaMemsetAsync(memory, 0, bytes), "clear memory");
}

void CudaMachine::upload(void* to, const void* from, std::size_t bytes) {
  check(cudaMemcpy(to, from, bytes, cudaMemcpyHostToDevice), "receive data");
}

void CudaMachine::download(void* to, const void* from, std::size_t bytes) {
  check(cudaMemcpy(to, from, bytes, cudaMemcpyDeviceToHost), "finish its work");
}

void CudaMachine::mark(int number) { check(cudaEventRecord(marks_[number]), "measure time"); }

double CudaMachine::seconds(int from, int to) {
  float milliseconds = 0;
  check(cudaEventSynchronize(marks_[to]), "finish its work");
  check(cudaEventElapsedTime(&milliseconds, marks_[from], marks_[to]), "measure time");
  return 1e-3 * double(milliseconds);
}

}  // namespace tureen::trainer::cuda
