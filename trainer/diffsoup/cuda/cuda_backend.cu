#include "trainer/common/cuda/cuda_machine.cuh"
#include "trainer/diffsoup/cuda/cuda_backend.hpp"
#include "trainer/diffsoup/cuda/kernel_backend.hpp"

namespace tureen::trainer {

void require_cuda() { cuda::CudaMachine(); }

std::unique_ptr<Backend> make_cuda_backend(std::span<const TrainingView> views,
                                           const Config& config) {
  return std::make_unique<cuda::KernelBackend<cuda::CudaMachine>>(views, config);
}

}  // namespace tureen::trainer
