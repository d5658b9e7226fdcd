// The device that computes training steps: chosen by the user, or automatically.
#pragma once

#include <memory>
#include <span>

#include "trainer/diffsoup/backend.hpp"

namespace tureen::trainer {

enum class Device {
  automatic,  // a GPU if one is available, else the processor
  cpu,
  cuda,
};

/// Whether this build has the CUDA backend. Its build needs nvcc.
bool has_cuda_backend();

/// Throws the ContextError of make_backend. It needs no views, so a run can fail early.
void require_device(Device device);

/// `threads`: number of processor threads, 0 for all cores. The views must outlive the backend.
/// For Device::cuda, throws ContextError if this build has no CUDA backend or no GPU is available,
/// and DeviceLimitError if the views do not fit into the GPU's memory. Device::automatic uses the
/// processor in all these cases.
std::unique_ptr<Backend> make_backend(std::span<const TrainingView> views, const Config& config,
                                      Device device, int threads);

}  // namespace tureen::trainer
