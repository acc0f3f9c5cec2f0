// SPDX-License-Identifier: Apache-2.0
// Goal: the simulated operator pushes the buttons when the fault plan needs it, and at no other time. Method:
// the begin and the end of each push within a run, with the faults that differ.
#include "machine.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "arm_limits.hpp"
#include "mamori/simbody_sim/arm_model.hpp"
#include "mamori/simbody_sim/arm_plant.hpp"
#include "mamori/trace/verifies.hpp"
#include "run_record.hpp"
#include "safe_arm_system.hpp"

namespace safe_arm {
namespace {

using mamori::Duration;
using mamori::Instant;
using mamori::sim::FaultKind;
using namespace mamori::verification;
using Times = std::vector<std::int64_t>;

/// Milliseconds at which a button changes, within 3 s. The fault is demanded at 1 s.
Times list_changes(FaultKind kind, bool Buttons::* button) {
    mamori::sim::FaultPlan fault{};
    fault.kind = kind;
    fault.at = 1000_ms;
    Times changes;
    bool was_pushed = false;
    for (std::int64_t ms = 0; ms < 3000; ++ms) {
        const bool is_pushed = calc_buttons(fault, Instant{ms * 1'000'000}).*button;
        if (is_pushed != was_pushed) {
            changes.push_back(ms);
        }
        was_pushed = is_pushed;
    }
    return changes;
}

TEST(MachineTest, OperatorStartsOnceAndNeverResets) {
    verifies("SWR-SAF-032");
    for (const FaultKind kind : {FaultKind::kNone, FaultKind::kPowerLoss, FaultKind::kStartStuck}) {
        EXPECT_EQ(list_changes(kind, &Buttons::start), (Times{250, 300}));
        EXPECT_EQ(list_changes(kind, &Buttons::reset), Times{});
    }
}

TEST(MachineTest, OperatorStartsAgainAfterOwnStopAndResetsOneThatNeedsIt) {
    verifies("SWR-SAF-033");
    for (const FaultKind kind : {FaultKind::kEmergencyStop, FaultKind::kEnablingSqueezed}) {
        EXPECT_EQ(list_changes(kind, &Buttons::start), (Times{250, 300, 2400, 2450}));
        EXPECT_EQ(list_changes(kind, &Buttons::reset), (Times{2000, 2050}));
    }
    for (const FaultKind kind :
         {FaultKind::kProtectiveStop, FaultKind::kEnablingReleased, FaultKind::kRunReleased}) {
        EXPECT_EQ(list_changes(kind, &Buttons::start), (Times{250, 300, 2400, 2450}));
        EXPECT_EQ(list_changes(kind, &Buttons::reset), Times{});
    }
}

TEST(MachineTest, PlantWhoseStateIsNoNumberIsReported) {
    verifies("SWR-SAF-016", Technique::kFaultInjection, Polarity::kViolation);
    const mamori::sim::LoadedModel loaded = mamori::sim::load_arm_model(SAFE_ARM_MODEL_FILE);
    ASSERT_TRUE(loaded.model.has_value()) << loaded.error;
    mamori::sim::ArmModel model = *loaded.model;
    RunRecord record{{}, model, {}, Instant{}, Instant{}};
    for (const double friction : {0.05, std::numeric_limits<double>::infinity()}) {
        model.joints[6].viscous_friction_nm_s_rad = friction;
        mamori::sim::ArmPlant plant{model};
        Machine sut{plant, virtual_host, {}, record};
        sut.apply(0U, Instant{}, kFrame);
        EXPECT_EQ(sut.is_plant_sound(), friction < 1.0);
    }
}

TEST(MachineTest, ChannelHoldsBackTheMessagesOf64Frames) {
    verifies("SWR-SAF-008");
    EXPECT_EQ(kChannelCapacity, 64U);
}

TEST(MachineTest, CreepingBrakeIsSeenBeforeTheFirstStart) {
    verifies("SWR-SAF-034");
    EXPECT_EQ(list_changes(FaultKind::kBrakeCreep, &Buttons::start), (Times{2400, 2450}));
}

}  // namespace
}  // namespace safe_arm
