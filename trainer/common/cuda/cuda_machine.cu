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
  (void)cudaGetLastError();  // what is thrown is no longer pending
  const std::string reason =
      std::string("the GPU could not ") + doing + " (" + sentence(result) + ")";
  if (result == cudaErrorMemoryAllocation)
    throw DeviceLimitError(reason + ": train fewer or smaller images, or use --device cpu");
  throw ContextError(reason);
}

CudaMachine::CudaMachine() {
  int count = 0;  // stays as it is where there is no driver
  cudaError_t result = cudaGetDeviceCount(&count);
  if (result == cudaSuccess && count == 0) result = cudaErrorNoDevice;
  if (result != cudaSuccess) {
    (void)cudaGetLastError();
    throw ContextError("no GPU answers (" + sentence(result) + "): use --device cpu");
  }
  int device = 0;
  check(cudaGetDevice(&device), "be chosen");
  cudaDeviceProp properties{};
  check(cudaGetDeviceProperties(&properties, device), "say what it is");
  name_ = properties.name;
  // Kernels for another generation of GPUs fail when they are launched: better to know it now.
  cudaFuncAttributes attributes;
  check(cudaFuncGetAttributes(&attributes, do_nothing), "run what this build has for it");
  // 2,048 threads a multiprocessor is what the largest hold; blocks of 256 and of 128 threads.
  resident_blocks_ = 16 * unsigned(properties.multiProcessorCount);
  for (cudaEvent_t& mark : marks_) check(cudaEventCreate(&mark), "keep time");
}

CudaMachine::~CudaMachine() {
  for (cudaEvent_t mark : marks_)
    if (mark) cudaEventDestroy(mark);
}

void* CudaMachine::allocate(std::size_t bytes) {
  void* memory = nullptr;
  check(cudaMalloc(&memory, bytes), "give memory");
  return memory;
}

void CudaMachine::release(void* memory) { cudaFree(memory); }

void CudaMachine::clear(void* memory, std::size_t bytes) {
  check(cudaMemsetAsync(memory, 0, bytes), "clear memory");
}

void CudaMachine::upload(void* to, const void* from, std::size_t bytes) {
  check(cudaMemcpy(to, from, bytes, cudaMemcpyHostToDevice), "take data");
}

void CudaMachine::download(void* to, const void* from, std::size_t bytes) {
  check(cudaMemcpy(to, from, bytes, cudaMemcpyDeviceToHost), "finish its work");
}

void CudaMachine::mark(int number) { check(cudaEventRecord(marks_[number]), "keep time"); }

double CudaMachine::seconds(int from, int to) {
  float milliseconds = 0;
  check(cudaEventSynchronize(marks_[to]), "finish its work");
  check(cudaEventElapsedTime(&milliseconds, marks_[from], marks_[to]), "keep time");
  return 1e-3 * double(milliseconds);
}

}  // namespace tureen::trainer::cuda
