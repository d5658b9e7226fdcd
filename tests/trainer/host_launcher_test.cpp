// The CUDA backend and its kernels, run on the processor: a whole step, compared with the
// processor's own backend.
#include <gtest/gtest.h>

#include "tests/trainer/backend_agreement.hpp"
#include "tests/trainer/host_machine.hpp"
#include "trainer/diffsoup/cuda/kernel_backend.hpp"

namespace tureen::trainer::test {

namespace host_launcher_test {

template <bool backwards>
std::unique_ptr<Backend> on_host(std::span<const TrainingView> views, const Config& config) {
  return std::make_unique<cuda::KernelBackend<HostMachine<backwards>>>(views, config);
}

TEST(HostLauncher, DrawsTheSameImages) { expect_same_images(on_host<false>); }
TEST(HostLauncher, DoesTheSameStep) { expect_same_step(on_host<false>); }
TEST(HostLauncher, DoesTheSameStepInOddCases) { expect_same_step_in_odd_cases(on_host<false>); }
TEST(HostLauncher, KeepsTheState) { expect_state_kept(on_host<false>); }

// On a GPU, blocks and threads run in any order: no bit may depend on it, or on an interruption.
TEST(HostLauncher, GivesTheSameBitsInAnyOrder) {
  expect_same_bits_again(on_host<false>, on_host<true>);
}

TEST(HostLauncher, EndsTheSameAfterABreak) { expect_same_end_after_a_break(on_host<false>); }
TEST(HostLauncher, QuarantinesWhatIsNotFinite) { expect_quarantine(on_host<false>); }
TEST(HostLauncher, TrainsAlike) { expect_same_training(on_host<false>, 50); }

}  // namespace host_launcher_test

}  // namespace tureen::trainer::test
