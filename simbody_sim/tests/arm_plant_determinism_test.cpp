// SPDX-License-Identifier: Apache-2.0
// Goal: a run is a function of its inputs, to the last bit.
// The hash goes into the result file, so that runs of other compilers and levels can be compared with it.
#include <cstdio>
#include <string>
#include <thread>

#include "arm_test_support.hpp"
#include "mamori/simbody_sim/computed_torque_controller.hpp"

namespace mamori::sim {
namespace {

using namespace test;

/// Motion under control, a runaway, a power loss: every part of the plant takes part.
std::uint64_t run_and_hash(ArmPlant& plant, const ArmModel& model) {
    ComputedTorqueController controller(model);
    StateHash hash;
    plant.reset(kBentPose);
    plant.set_observer(&hash);
    JointVector target = kBentPose;
    JointVector speed{};
    for (int frame = 0; frame < 700; ++frame) {
        speed.fill(frame < 100 ? 0.0 : 0.3);
        for (std::size_t i = 0U; i < kArmJointCount; ++i) {
            target[i] += 1.0e-3 * speed[i];
        }
        if (frame == 300) {
            plant.faults().torque_runaway[3] = 0.8;
        }
        if (frame == 400) {
            plant.faults().power_lost = true;
        }
        EXPECT_EQ(plant.step(command(controller.calc_torque(target, speed, {}, plant.positions(),
                                                            plant.velocities())),
                             1_ms),
                  Status::kOk);
    }
    plant.set_observer(nullptr);
    return hash.get();
}

std::uint64_t run_in_new_plant(const ArmModel& model) {
    ArmPlant plant(model);
    return run_and_hash(plant, model);
}

TEST(ArmPlantDeterminismTest, ARepeatedRunGivesTheSameBits) {
    verifies("SWR-SIM-010", Technique::kBackToBack);
    const ArmModel model = load_shipped_model();
    const std::uint64_t first = run_in_new_plant(model);
    char text[17];
    std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(first));
    RecordProperty("state_hash", text);

    EXPECT_EQ(run_in_new_plant(model), first);
}

TEST(ArmPlantDeterminismTest, AUsedPlantIsAsGoodAsNewAfterAReset) {
    verifies("SWR-SIM-010", Technique::kBackToBack);
    const ArmModel model = load_shipped_model();
    ArmPlant plant(model);

    const std::uint64_t first = run_and_hash(plant, model);
    EXPECT_EQ(run_and_hash(plant, model), first);
}

TEST(ArmPlantDeterminismTest, TwoPlantsInTwoThreadsGiveTheBitsOfOne) {
    verifies("SWR-SIM-010", Technique::kBackToBack);
    const ArmModel model = load_shipped_model();
    const std::uint64_t alone = run_in_new_plant(model);
    std::uint64_t left = 0U;
    std::uint64_t right = 0U;

    std::thread left_thread([&left, &model] { left = run_in_new_plant(model); });
    std::thread right_thread([&right, &model] { right = run_in_new_plant(model); });
    left_thread.join();
    right_thread.join();
    EXPECT_EQ(left, alone);
    EXPECT_EQ(right, alone);
}

TEST(ArmPlantDeterminismTest, LengthOfTheCallsDoesNotMatter) {
    verifies("SWR-SIM-010", Technique::kEquivalenceClasses);
    const ArmModel model = load_shipped_model();
    ArmPlant whole(model);
    ArmPlant pieces(model);
    whole.reset(kBentPose);
    pieces.reset(kBentPose);
    safety::ArmOutputs fall;
    fall.brake_release = true;
    fall.relay_close = true;

    ASSERT_EQ(whole.step(fall, 200_ms), Status::kOk);
    for (int piece = 0; piece < 800; ++piece) {
        ASSERT_EQ(pieces.step(fall, kPlantSubstep), Status::kOk);
        static_cast<void>(pieces.sample());
    }
    EXPECT_EQ(whole.positions(), pieces.positions());
    EXPECT_EQ(whole.velocities(), pieces.velocities());
}

}  // namespace
}  // namespace mamori::sim
