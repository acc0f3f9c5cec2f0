// SPDX-License-Identifier: Apache-2.0
// Goal: the process image is a payload whose every field travels, and its default commands the safe state.
#include "mamori/safety/arm/arm_device.hpp"

#include "mamori/trace/verifies.hpp"

namespace mamori::safety {
namespace {

using namespace verification;

struct Count {
    std::size_t scalars{0U};
    template <typename T>
    constexpr void operator()(const T&) noexcept {
        ++scalars;
    }
};

TEST(ArmDeviceTest, EveryFieldOfTheImageTravels) {
    verifies("SWR-ARM-001", Technique::kInterface);
    Count inputs;
    Count outputs;

    visit_scalars(ArmInputs{}, inputs);
    visit_scalars(ArmOutputs{}, outputs);
    EXPECT_EQ(inputs.scalars, 5U * kArmJointCount + 17U)
        << "two encoders, torque, brake, reference; 16 contacts and a clock";
    EXPECT_EQ(outputs.scalars, kArmJointCount + 3U);
}

TEST(ArmDeviceTest, DefaultOutputsCutTorqueAndCloseBrakes) {
    verifies("SWR-ARM-001", Technique::kErrorGuessing, Polarity::kViolation);
    const ArmOutputs outputs;

    EXPECT_FALSE(outputs.torque_enable);
    EXPECT_FALSE(outputs.brake_release);
    EXPECT_FALSE(outputs.relay_close);
    for (const double torque_nm : outputs.torque_nm) {
        EXPECT_EQ(torque_nm, 0.0);
    }
}

}  // namespace
}  // namespace mamori::safety
