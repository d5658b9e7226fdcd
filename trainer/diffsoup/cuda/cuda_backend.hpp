// The backend for NVIDIA GPUs; trainer/diffsoup/device.hpp chooses between it and the processor.
#pragma once

#include <memory>
#include <span>

#include "trainer/diffsoup/backend.hpp"

namespace tureen::trainer {

/// Throws the ContextError of make_cuda_backend.
void require_cuda();

/// On the current device; CUDA_VISIBLE_DEVICES tells which that is. The views must outlive the
/// backend. Throws ContextError where no GPU answers or this build has no code for it, and
/// DeviceLimitError where its memory is too small for the views; upload() and step() throw the
/// latter, too.
std::unique_ptr<Backend> make_cuda_backend(std::span<const TrainingView> views,
                                           const Config& config);

}  // namespace tureen::trainer
