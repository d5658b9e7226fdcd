// The backend for NVIDIA GPUs; trainer/diffsoup/device.hpp chooses between it and the processor.
#pragma once

#include <memory>
#include <span>

#include "trainer/diffsoup/backend.hpp"

namespace tureen::trainer {

/// Throws the ContextError of make_cuda_backend.
void require_cuda();

/// Uses the current device, which CUDA_VISIBLE_DEVICES selects. The views must outlive the backend.
/// Throws ContextError if no GPU is available or this build has no code for it, and
/// DeviceLimitError if its memory is too small for the views. upload() and step() also throw
/// DeviceLimitError.
std::unique_ptr<Backend> make_cuda_backend(std::span<const TrainingView> views,
                                           const Config& config);

}  // namespace tureen::trainer
