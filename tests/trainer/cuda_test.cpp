// The CUDA backend compared with the processor's, if there is a GPU; and the choice between them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <optional>
#include <string>

#include "base/error.hpp"
#include "tests/support/errors.hpp"
#include "tests/trainer/backend_agreement.hpp"
#include "trainer/diffsoup/device.hpp"

namespace tureen::trainer::test {

namespace cuda_test {

std::unique_ptr<Backend> on_gpu(std::span<const TrainingView> views, const Config& config) {
  return make_backend(views, config, Device::cuda, 1);
}

/// The reason why there is no GPU to test.
std::optional<tureen::test::Refusal> reason_to_skip() {
  return tureen::test::error_of<ContextError>([] { (void)on_gpu({}, {}); });
}

class Cuda : public testing::Test {
 protected:
  void SetUp() override {
    if (const auto reason = reason_to_skip()) GTEST_SKIP() << reason->reason;
  }
};

TEST_F(Cuda, DrawsTheSameImages) { expect_same_images(on_gpu); }
TEST_F(Cuda, DoesTheSameStep) { expect_same_step(on_gpu); }
TEST_F(Cuda, DoesTheSameStepInOddCases) { expect_same_step_in_odd_cases(on_gpu); }
TEST_F(Cuda, KeepsTheState) { expect_state_kept(on_gpu); }
TEST_F(Cuda, GivesTheSameBitsAgain) { expect_same_bits_again(on_gpu, on_gpu); }
TEST_F(Cuda, EndsTheSameAfterABreak) { expect_same_end_after_a_break(on_gpu); }
TEST_F(Cuda, QuarantinesWhatIsNotFinite) { expect_quarantine(on_gpu); }
TEST_F(Cuda, TrainsAlike) { expect_same_training(on_gpu, 50); }

TEST(Device, TheProcessorIsChosenByName) {
  EXPECT_EQ(make_backend({}, {}, Device::cpu, 1)->description(), "CPU, 1 thread");
}

TEST(Device, WithoutAGpuTheProcessorTrainsAndCudaSaysWhy) {
  const auto reason = reason_to_skip();
  if (!reason) GTEST_SKIP() << "there is a GPU";
  EXPECT_EQ(make_backend({}, {}, Device::automatic, 1)->description(), "CPU, 1 thread");
  EXPECT_THAT(reason, tureen::test::ErrorAt("", "--device cpu"));
}

}  // namespace cuda_test

}  // namespace tureen::trainer::test
