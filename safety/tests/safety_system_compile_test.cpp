// SPDX-License-Identifier: Apache-2.0
// Goal: the compiler rejects a safety table without meaning, names the faulty element and the rule.
// Method: the build's own compiler is run on one source, without and with a defect.
#include <gtest/gtest.h>

#include "compile_fail/compiler.hpp"
#include "mamori/trace/verifies.hpp"

namespace mamori::safety {
namespace {

using namespace verification;

struct Defect {
    const char* macro;
    const char* faulty;    ///< the element, as the compiler prints it
    const char* sentence;  ///< part of the rule
};

class SafetySystemCompileTest : public ::testing::TestWithParam<Defect> {};
class SelfTestRowCompileTest : public ::testing::TestWithParam<Defect> {};
class ProtectRowCompileTest : public ::testing::TestWithParam<Defect> {};

TEST(SafetySystemCompileTest, ATableWithoutADefectCompiles) {
    verifies("SWR-CYC-002");
    const rig::Compilation result = rig::compile("safety_system_source.cpp", "MAMORI_DEFECT_NONE");

    EXPECT_EQ(result.exit_status, 0) << result.messages;
}

void expect_rejected(const Defect& defect) {
    const rig::Compilation result =
        rig::compile("safety_system_source.cpp", std::string{"MAMORI_DEFECT_"} + defect.macro);

    EXPECT_EQ(result.exit_status, 1) << result.messages;
    EXPECT_TRUE(result.names(defect.faulty)) << result.messages;
    EXPECT_TRUE(result.names(defect.sentence)) << result.messages;
}

TEST_P(SafetySystemCompileTest, IsRejectedWithTheFaultyElement) {
    verifies("SWR-CYC-002", Technique::kBoundaryValues, Polarity::kViolation);
    expect_rejected(GetParam());
}

class CheckpointCompileTest : public ::testing::TestWithParam<Defect> {};

TEST_P(CheckpointCompileTest, IsRejectedWithTheFaultyElement) {
    verifies("SWR-CYC-015", Technique::kEquivalenceClasses, Polarity::kViolation);
    expect_rejected(GetParam());
}

class StopSourceCompileTest : public ::testing::TestWithParam<Defect> {};

TEST_P(StopSourceCompileTest, IsRejectedWithTheFaultyElement) {
    verifies("SWR-CYC-012", Technique::kEquivalenceClasses, Polarity::kViolation);
    expect_rejected(GetParam());
}

TEST_P(SelfTestRowCompileTest, IsRejectedWithTheFaultyElement) {
    verifies("SWR-CYC-023", Technique::kBoundaryValues, Polarity::kViolation);
    expect_rejected(GetParam());
}

TEST_P(ProtectRowCompileTest, IsRejectedWithTheFaultyElement) {
    verifies("SWR-CYC-035", Technique::kBoundaryValues, Polarity::kViolation);
    expect_rejected(GetParam());
}

TEST(ProtectRowLimitsCompileTest, RowsAtTheirLimitsCompile) {
    verifies("SWR-CYC-035", Technique::kBoundaryValues);
    const rig::Compilation result = rig::compile("safety_system_source.cpp", "MAMORI_DEFECT_NONE");

    EXPECT_EQ(result.exit_status, 0) << result.messages;
}

constexpr Defect kDefects[] = {
    {"UNANSWERED", "Fault::kFast", "a declared fault has a reaction"},
    {"NUMBERS", "Fault::kSilent", "lists the enumerators 0, 1, ..."},
    {"REACTION", "TableRow<0>", "an enumerator of mamori::safety::Reaction"},
    {"OTHER_REACTION", "TableRow<0>", "an enumerator of mamori::safety::Reaction"},
    {"CONFIRM_OTHER_FAULT", "faults", "all faults of a system are enumerators of one enumeration"},
    {"RAISE_OTHER_FAULT", "faults", "all faults of a system are enumerators of one enumeration"},
    {"LATE_OTHER_FAULT", "faults", "all faults of a system are enumerators of one enumeration"},
    {"SELF_TEST_OTHER_FAULT", "faults", "all faults of a system are enumerators of one enumeration"},
    {"BRAKE_OTHER_FAULT", "faults", "all faults of a system are enumerators of one enumeration"},
    {"OTHER_CORE", "Reader", "a supervised component runs on the core and in the class of the safety cycle"},
    {"TWO_DECIDERS", "TableRow<2>", "exactly one component derived from SafetyCycle"},
    {"NO_MODE", "Reader", "ComponentRunsIn"},
    {"WATCHDOG_LATE", "TableRow<0>", "the period of the safety cycle is inside the window of the watchdog"},
    {"STRANGER", "TableRow<0>", "no window of the table runs"},
    {"TWICE", "Reader", "two supervise(...)"},
    {"ALIVE", "Reader", "alive(...) is out of range"},
    {"DEADLINE", "Reader", "deadline(...) is out of range"},
    {"RAISED", "Reader", "raises(...) names a fault"},
    {"NOTHING_PROVEN", "kSomethingProven", "nothing would permit the service of the watchdog"},
    {"CONFIRM_UNDECLARED", "TableRow<0>", "confirm(...) names a fault"},
    {"CONFIRM_TWICE", "Fault::kFast", "two confirm(...)"},
    {"CONFIRM_NEVER", "Fault::kFast", "confirm(...) is out of range"},
    {"HEALING", "Fault::kFast", "confirm(...) is out of range"},
    {"NO_CYCLE", "kCycleOnce", "exactly one cycle(...)"},
    {"CYCLE_TWICE", "kCycleOnce", "exactly one cycle(...)"},
    {"NO_STOPS", "cycle", "states its StopBounds once"},
    {"NO_BRAKES", "cycle", "states its BrakeLimits once"},
    {"NO_WATCHDOG", "cycle", "states its WatchdogWindow once"},
    {"NO_FEEDBACK", "cycle", "states torque_feedback(...) once"},
    {"NO_LATENESS", "cycle", "states tolerated_lateness(...) once"},
    {"NO_LATE_FAULT", "cycle", "states on_late_reaction(...) once"},
    {"NO_SELF_TEST_FAULT", "cycle", "states on_failed_self_test(...) once"},
    {"NO_BRAKE_FAULT", "cycle", "states on_unconfirmed_brakes(...) once"},
    {"BRAKE_FAULT", "kCycleFaultDeclared", "does not declare"},
    {"BOUNDS_TWICE", "cycle", "states its StopBounds once"},
    {"SS2", "kStopBoundsInRange", "bounds of SS1 and SS2 are positive"},
    {"SS1", "kStopBoundsInRange", "bounds of SS1 and SS2 are positive"},
    {"BRAKES_SLOW", "kBrakesHaveTime", "shorter than the bound of SS1"},
    {"BRAKES_WITHOUT_TIME", "kBrakesHaveTime", "shorter than the bound of SS1"},
    {"WATCHDOG_NEGATIVE", "kWatchdogInRange", "window of the watchdog is out of range"},
    {"WATCHDOG_EMPTY", "kWatchdogInRange", "window of the watchdog is out of range"},
    {"FEEDBACK", "kTorqueFeedbackInRange", "torque feedback is positive"},
    {"LATENESS", "kLatenessInRange", "lateness is not negative"},
    {"LATE_FAULT", "kCycleFaultDeclared", "does not declare"},
    {"SELF_TEST_FAULT", "kCycleFaultDeclared", "does not declare"},
    {"BRAKES_FIRST_OTHER_FAULT", "faults", "all faults of a system are enumerators of one enumeration"},
    {"BRAKES_FIRST_UNDECLARED", "kBrakesFirstDeclared", "does not declare"},
    {"BRAKES_FIRST_BY_SS1", "kBrakesFirstBySto", "whose reaction is STO in no mode"},
    {"BRAKES_FIRST_WITHOUT_CONTACTS", "kBrakesFirstHasContacts", "needs brakes with contacts"},
};
constexpr Defect kCheckpointDefects[] = {
    {"CHECKPOINT_LIST", "SupervisionFault::kEdgeLeavesFinal, 0", "edge out of a final checkpoint"},
    {"CHECKPOINT_ENTITY", "Reader", "names an entity that its table does not have"},
    {"CHECKPOINT_TWICE", "Decider", "two components report the checkpoints of one entity"},
    {"CHECKPOINT_SUPERVISOR", "Decider", "checkpoints<...>(...) of two supervisors or tables"},
    {"CHECKPOINT_FORGOTTEN", "TableRow<0>", "has no component"},
};
constexpr Defect kSourceDefects[] = {
    {"NO_STANDSTILL", "Unconfirmed<mamori::safety::StopConfirmation::kStandstill>",
     "nothing confirms the stop"},
    {"NO_CLOSED_BRAKES", "Unconfirmed<mamori::safety::StopConfirmation::kClosedBrakes>",
     "nothing confirms the stop"},
    {"NO_TORQUE_OFF", "Unconfirmed<mamori::safety::StopConfirmation::kTorqueOff>",
     "nothing confirms the stop"},
    {"SOURCE_TWICE", "TableRow<1>", "deliver one confirmation"},
    {"SOURCE_STRANGER", "TableRow<0>", "confirmed_by(...) names an output of a component that no window"},
    {"SOURCE_UNSUPERVISED", "Reader", "the component that confirms a stop has no supervise(...)"},
    {"SOURCE_UNCONNECTED", "Reader", "is connected to the safety cycle"},
    {"SOURCE_LATER", "Reader", "runs before the safety cycle"},
    {"SOURCE_OF_NOTHING", "confirmed_by", "names an output and what it confirms"},
};
INSTANTIATE_TEST_SUITE_P(EachDefect, SafetySystemCompileTest, ::testing::ValuesIn(kDefects),
                         [](const auto& one) { return std::string{one.param.macro}; });
INSTANTIATE_TEST_SUITE_P(EachDefect, CheckpointCompileTest, ::testing::ValuesIn(kCheckpointDefects),
                         [](const auto& one) { return std::string{one.param.macro}; });
INSTANTIATE_TEST_SUITE_P(EachDefect, StopSourceCompileTest, ::testing::ValuesIn(kSourceDefects),
                         [](const auto& one) { return std::string{one.param.macro}; });

constexpr Defect kSelfTestDefects[] = {
    {"TESTED_TWICE", "Fault::kFast", "two self_test(...)"},
    {"TESTED_OTHER_FAULT", "faults", "all faults of a system are enumerators of one enumeration"},
    {"TESTED_FAULT", "TableRow<1>", "self_test(...) raises a fault"},
    {"TESTED_TOO_OFTEN", "Fault::kFast", "at least two periods of the safety cycle"},
    {"TESTED_WITHOUT_TIME", "self_test", "states found_within(...)"},
};
INSTANTIATE_TEST_SUITE_P(EachDefect, SelfTestRowCompileTest, ::testing::ValuesIn(kSelfTestDefects),
                         [](const auto& one) { return std::string{one.param.macro}; });

class AssumptionRowCompileTest : public ::testing::TestWithParam<Defect> {};

TEST_P(AssumptionRowCompileTest, IsRejectedWithTheFaultyElement) {
    verifies("SWR-CYC-036", Technique::kBoundaryValues, Polarity::kViolation);
    expect_rejected(GetParam());
}

constexpr Defect kAssumptionDefects[] = {
    {"ASSUMPTION_ORDER", "TableRow<0>", "names the enumerators 0, 1, ... of one enumeration"},
    {"ASSUMPTION_TWICE", "TableRow<1>", "names the enumerators 0, 1, ... of one enumeration"},
    {"ASSUMPTION_TIME", "TableRow<1>", "the time of assume(...) is positive"},
};
INSTANTIATE_TEST_SUITE_P(EachDefect, AssumptionRowCompileTest, ::testing::ValuesIn(kAssumptionDefects),
                         [](const auto& one) { return std::string{one.param.macro}; });

constexpr Defect kProtectDefects[] = {
    {"PROTECTED_UNANSWERED", "protect", "states raises(...), the fault of a loss"},
    {"PROTECTED_UNSTAMPED", "protect", "states sent_at_ns"},
    {"PROTECTED_OTHER_FAULT", "faults", "all faults of a system are enumerators of one enumeration"},
    {"PROTECTED_FAULT", "OtherReceiver", "protect(...) raises a fault"},
    {"PROTECTED_STRANGER", "TableRow<1>", "protect(...) names a receiver that no window of the table runs"},
    {"PROTECTED_TWICE", "Receiver", "two protect(...)"},
    {"PROTECTED_TOO_YOUNG", "OtherReceiver", "is at least the period of the receiver"},
    {"PROTECTED_LEAD", "OtherReceiver", "is at least the period of the receiver"},
    {"PROTECTED_LOSSES", "OtherReceiver", "a gap of more messages than fit into fresh_within(...)"},
    {"PROTECTED_OTHER_CORE", "OtherReceiver", "runs on the core and in the class of the safety cycle"},
};
INSTANTIATE_TEST_SUITE_P(EachDefect, ProtectRowCompileTest, ::testing::ValuesIn(kProtectDefects),
                         [](const auto& one) { return std::string{one.param.macro}; });

}  // namespace
}  // namespace mamori::safety
