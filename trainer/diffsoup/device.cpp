#include "trainer/diffsoup/device.hpp"

#include "base/error.hpp"
#if defined(TUREEN_HAS_CUDA)
#include "trainer/diffsoup/cuda/cuda_backend.hpp"
#endif

namespace tureen::trainer {

#if defined(TUREEN_HAS_CUDA)

bool has_cuda_backend() { return true; }

#else

bool has_cuda_backend() { return false; }

namespace {

void require_cuda() {
  throw ContextError("this build has no CUDA backend (nvcc was not found)", "use --device cpu");
}

std::unique_ptr<Backend> make_cuda_backend(std::span<const TrainingView>, const Config&) {
  require_cuda();
  return nullptr;
}

}  // namespace

#endif

void require_device(Device device) {
  if (device == Device::cuda) require_cuda();
}

std::unique_ptr<Backend> make_backend(std::span<const TrainingView> views, const Config& config,
                                      Device device, int threads) {
  if (device == Device::cuda) return make_cuda_backend(views, config);
  if (device == Device::automatic && has_cuda_backend()) {
    try {
      return make_cuda_backend(views, config);
    } catch (const ContextError&) {      // no GPU
    } catch (const DeviceLimitError&) {  // too little GPU memory
    }
  }
  return make_cpu_backend(views, config, threads);
}

}  // namespace tureen::trainer
