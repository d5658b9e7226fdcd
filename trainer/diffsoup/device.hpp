// Which machine does the arithmetic of training: named by the user, or what is there.
#pragma once

#include <memory>
#include <span>

#include "trainer/diffsoup/backend.hpp"

namespace tureen::trainer {

enum class Device {
  automatic,  // a GPU where one answers, else the processor
  cpu,
  cuda,
};

/// Whether this build has the CUDA backend: it is built where nvcc is.
bool has_cuda_backend();

/// Throws the ContextError of make_backend, before there are views to make it for.
void require_device(Device device);

/// `threads` are the processor's, 0 for all cores. The views must outlive the backend. Throws
/// ContextError for Device::cuda where this build has no CUDA backend or no GPU answers, and
/// DeviceLimitError where the views do not fit into the GPU's memory; Device::automatic trains on
/// the processor in all these cases.
std::unique_ptr<Backend> make_backend(std::span<const TrainingView> views, const Config& config,
                                      Device device, int threads);

}  // namespace tureen::trainer
