// SPDX-License-Identifier: Apache-2.0
// Goal: the tables of the example say what its design says. Method: the compiled tables are read row by row.
#include "safe_arm_system.hpp"

#include "mamori/trace/verifies.hpp"
#include "table_output.hpp"

namespace safe_arm {
namespace {

using mamori::safety::calc_reaction;
using mamori::safety::FaultIndex;
using mamori::safety::FaultRecord;
using mamori::safety::FaultRegister;
using mamori::safety::Reaction;
using namespace mamori::verification;

bool is_forward(const mamori::OutPortBase& source, const mamori::InPortBase& sink) {
    for (const mamori::ConnectionRow& row : executive.get_view().connections) {
        if (row.source == &source && row.sink == &sink) {
            return row.is_forward_in_window;
        }
    }
    ADD_FAILURE() << "no such connection";
    return false;
}

TEST(SafeArmSystemTest, MeasurementIsJudgedAndAnsweredInItsFrame) {
    verifies("SWR-SAF-017");

    EXPECT_TRUE(is_forward(reader.reading, monitor.reading));
    EXPECT_TRUE(is_forward(monitor.state, supervisor.arm_state));
    EXPECT_LT(executive.get_view().windows[0].offset, executive.get_view().windows[3].offset)
        << "the gate runs after the supervisor";
    EXPECT_EQ(executive.get_view().components[executive.get_view().windows[3].first_component + 1U], &gate);
}

TEST(SafeArmSystemTest, ControllerReachesTheDrivesThroughProtectionAndGateOnly) {
    verifies("SWR-SAF-017", Technique::kErrorGuessing, Polarity::kViolation);

    for (const mamori::ConnectionRow& row : executive.get_view().connections) {
        if (row.source == &controller.command) {
            EXPECT_EQ(row.sink, &command_sender.in);
        }
    }
}

TEST(SafeArmSystemTest, ThePermissionOfTheGateComesFromTheSafetyCycleOnly) {
    verifies("ARC-004", Technique::kInterface);
    const mamori::safety::SafetyCycle& cycle = supervisor;

    std::size_t permissions = 0U;
    for (const mamori::ConnectionRow& row : executive.get_view().connections) {
        if (row.sink == &gate.stop) {
            EXPECT_EQ(row.source, &supervisor.stop);
            ++permissions;
        }
    }
    EXPECT_EQ(permissions, 1U);
    EXPECT_EQ(executive.get_view().components[executive.get_view().windows[0].first_component + 2U], &cycle);
}

TEST(ArmReactionsTest, EachFaultAloneLeadsToItsRow) {
    verifies("SWR-SAF-002", Technique::kFaultInjection, Polarity::kViolation);
    for (std::size_t i = 0U; i < kArmFaultCount; ++i) {
        std::array<FaultRecord, kArmFaultCount> storage{};
        FaultRegister faults{storage};
        faults.report(static_cast<FaultIndex>(i), true, mamori::Instant{});

        const mamori::safety::ReactionDemand demand = calc_reaction(executive.get_view().reactions, faults);
        EXPECT_EQ(demand.fault, i);
        EXPECT_GE(demand.reaction, Reaction::kSs2) << get_fault_names()[i];
        EXPECT_EQ(demand.within, 2_ms);
    }
}

Reaction find_reaction(ArmFault fault, OperatingMode mode) {
    return mamori::safety::find_demand(executive.get_view().reactions, to_index(fault),
                                       static_cast<std::size_t>(mode))
        .reaction;
}

TEST(ArmReactionsTest, TheEnablingDeviceIsNeededInAllModesButAutomatic) {
    verifies("SWR-SAF-063", Technique::kEquivalenceClasses, Polarity::kViolation);
    for (const OperatingMode mode :
         {OperatingMode::kHoldToRun, OperatingMode::kReducedSpeed, OperatingMode::kSwitchFailed}) {
        EXPECT_EQ(find_reaction(ArmFault::kEnableLost, mode), Reaction::kSs2);
        EXPECT_EQ(find_reaction(ArmFault::kEnablingSqueezed, mode), Reaction::kSs1);
    }
    EXPECT_EQ(find_reaction(ArmFault::kRunReleased, OperatingMode::kHoldToRun), Reaction::kSs2);
    EXPECT_EQ(find_reaction(ArmFault::kRunReleased, OperatingMode::kSwitchFailed), Reaction::kSs2);
}

TEST(ArmReactionsTest, AControlThatAModeDoesNotNeedStopsNothingAndAllOtherFaultsStopInEachMode) {
    verifies("SWR-SAF-063", Technique::kEquivalenceClasses);
    std::size_t without_stop = 0U;
    for (std::size_t i = 0U; i < kArmFaultCount; ++i) {
        for (std::size_t mode = 0U; mode <= static_cast<std::size_t>(OperatingMode::kSwitchFailed); ++mode) {
            const Reaction reaction =
                find_reaction(static_cast<ArmFault>(i), static_cast<OperatingMode>(mode));
            EXPECT_TRUE(reaction == Reaction::kNone || reaction >= Reaction::kSs2) << i << " in " << mode;
            without_stop += reaction == Reaction::kNone ? 1U : 0U;
        }
    }
    EXPECT_EQ(find_reaction(ArmFault::kEnableLost, OperatingMode::kAutomatic), Reaction::kNone);
    EXPECT_EQ(find_reaction(ArmFault::kEnablingSqueezed, OperatingMode::kAutomatic), Reaction::kNone);
    EXPECT_EQ(find_reaction(ArmFault::kRunReleased, OperatingMode::kAutomatic), Reaction::kNone);
    EXPECT_EQ(find_reaction(ArmFault::kRunReleased, OperatingMode::kReducedSpeed), Reaction::kNone);
    EXPECT_EQ(without_stop, 4U);
}

TEST(SafeArmSystemTest, EachModeRunsAllComponentsSoASwitchDeactivatesNone) {
    verifies("SWR-SAF-061", Technique::kInterface);
    const mamori::SystemView& view = executive.get_view();

    EXPECT_EQ(view.modes.modes.size(), 4U);
    EXPECT_EQ(view.modes.members.size(), 4U * view.components.size());
    EXPECT_EQ(mamori::find_safe_mode(view.modes), static_cast<std::size_t>(OperatingMode::kSwitchFailed));
}

TEST(ArmReactionsTest, NoFaultDemandsNothing) {
    verifies("SWR-SAF-002");
    std::array<FaultRecord, kArmFaultCount> storage{};
    FaultRegister faults{storage};

    EXPECT_EQ(calc_reaction(executive.get_view().reactions, faults).reaction,
              mamori::safety::Reaction::kNone);
}

}  // namespace
}  // namespace safe_arm
