// SPDX-License-Identifier: Apache-2.0
// Goal: a machine whose assumptions do not all hold never becomes operational, and says which one it is.
// Method: scripted checks of five assumptions, each of which fails, is lost later, or stays unknown in turn;
// both sides of each time; the safe-state machine at the end of the chain.
#include "mamori/safety/assumptions/assumption_monitor.hpp"

#include <array>
#include <string>

#include "mamori/safety/assumptions/assumption_checks.hpp"
#include "mamori/safety/reaction/safe_state_machine.hpp"
#include "mamori/safety/self_test/cpu_check.hpp"
#include "mamori/safety/self_test/march.hpp"
#include "mamori/safety/self_test/ram_area.hpp"
#include "mamori/safety/self_test/region_crc.hpp"
#include "mamori/safety/self_test/schedule.hpp"
#include "mamori/trace/verifies.hpp"
#include "mamori/verification/failed_check.hpp"

namespace mamori::safety {
namespace {

using namespace verification;

enum class Assumption : AssumptionIndex {
    kTickSource,
    kWatchdog,
    kMemoryProtection,
    kFpuMode,
    kBudget,
    kCount
};
constexpr std::size_t kCount = static_cast<std::size_t>(Assumption::kCount);

class FakeCheck final : public AssumptionCheck {
  public:
    SelfTestStatus check() noexcept override {
        ++calls;
        return answer;
    }
    std::size_t calls{0U};
    SelfTestStatus answer{SelfTestStatus::kPassed};
};

std::array<FakeCheck, kCount> g_checks;
constexpr std::array kAssumptions{
    assume(Assumption::kTickSource, "tick source", g_checks[0], Duration{100}),
    assume(Assumption::kWatchdog, "watchdog", g_checks[1], Duration{200}),
    assume(Assumption::kMemoryProtection, "memory protection", g_checks[2], Duration{300}),
    assume(Assumption::kFpuMode, "FPU mode", g_checks[3], Duration{300}),
    assume(Assumption::kBudget, "budget", g_checks[4], Duration{300}),
};
static_assert(checks_all<kAssumptions, Assumption::kCount>());

class AssumptionMonitorTest : public ::testing::TestWithParam<std::size_t> {
  protected:
    AssumptionMonitorTest() { g_checks.fill(FakeCheck{}); }
    SelfTestStatus step(std::int64_t at_ns) { return sut_.step(Instant{at_ns}); }
    static FakeCheck& check() { return g_checks[GetParam()]; }
    static const AssumptionRow& row() { return kAssumptions[GetParam()]; }
    void expect_named() const {
        EXPECT_EQ(sut_.get_failed(), GetParam());
        EXPECT_EQ(std::string(sut_.get_failed_name()), row().name);
    }

    AssumptionMonitor sut_{kAssumptions};
};

TEST_P(AssumptionMonitorTest, AssumptionThatIsNotKnownKeepsTheMonitorRunningUntilItHolds) {
    verifies("SWR-AOU-001", Technique::kBoundaryValues);
    check().answer = SelfTestStatus::kRunning;
    ASSERT_EQ(sut_.get_status(), SelfTestStatus::kRunning);

    EXPECT_EQ(step(1000), SelfTestStatus::kRunning);
    EXPECT_EQ(step(1000 + row().within.ns), SelfTestStatus::kRunning) << "its time is included";
    check().answer = SelfTestStatus::kPassed;
    EXPECT_EQ(step(100000), SelfTestStatus::kPassed);
    EXPECT_EQ(sut_.get_failed(), kNoAssumption);
    EXPECT_EQ(std::string(sut_.get_failed_name()), "");
}

TEST_P(AssumptionMonitorTest, AssumptionThatDoesNotHoldFailsForGoodAndIsNamed) {
    verifies("SWR-AOU-001", Technique::kFaultInjection, Polarity::kViolation);
    check().answer = SelfTestStatus::kFailed;

    EXPECT_EQ(step(0), SelfTestStatus::kFailed);
    expect_named();
    const std::size_t calls = check().calls;
    check().answer = SelfTestStatus::kPassed;
    EXPECT_EQ(step(1), SelfTestStatus::kFailed) << "it does not heal";
    EXPECT_EQ(sut_.get_status(), SelfTestStatus::kFailed);
    EXPECT_EQ(check().calls, calls);
    expect_named();
}

TEST_P(AssumptionMonitorTest, CorruptedAnswerIsAFailure) {
    verifies("SWR-AOU-001", Technique::kFaultInjection, Polarity::kViolation);
    check().answer = static_cast<SelfTestStatus>(77);

    EXPECT_EQ(step(0), SelfTestStatus::kFailed);
    expect_named();
}

TEST_P(AssumptionMonitorTest, AssumptionThatIsLostLaterFails) {
    verifies("SWR-AOU-003", Technique::kFaultInjection, Polarity::kViolation);
    ASSERT_EQ(step(0), SelfTestStatus::kPassed);
    check().answer = SelfTestStatus::kFailed;

    EXPECT_EQ(step(10000), SelfTestStatus::kFailed);
    expect_named();
}

TEST_P(AssumptionMonitorTest, AssumptionThatIsNotKnownAfterItsTimeFails) {
    verifies("SWR-AOU-001", Technique::kBoundaryValues, Polarity::kViolation);
    check().answer = SelfTestStatus::kRunning;
    ASSERT_EQ(step(1000), SelfTestStatus::kRunning);

    EXPECT_EQ(step(1001 + row().within.ns), SelfTestStatus::kFailed);
    expect_named();
}

TEST_P(AssumptionMonitorTest, MachineWithoutOneOfThemIsLockedOutAndNeverStands) {
    verifies("SWR-AOU-001", Technique::kInterface, Polarity::kViolation);
    SafeStateMachine machine({Duration{100}, Duration{100}});
    SafeStateInputs inputs;
    inputs.demand = Reaction::kNone;
    check().answer = SelfTestStatus::kRunning;

    for (std::int64_t at = 0; at <= 301; ++at) {
        inputs.self_test = combine(step(at), SelfTestStatus::kPassed);
        const SafeState state = machine.step(inputs);
        ASSERT_EQ(state, at <= row().within.ns ? SafeState::kSelfTest : SafeState::kLockedOut) << at;
    }
}

INSTANTIATE_TEST_SUITE_P(EachAssumption, AssumptionMonitorTest, ::testing::Range(std::size_t{0U}, kCount));

TEST(AllAssumptionsTest, HoldAndGoOnBeingLookedAt) {
    verifies("SWR-AOU-003");
    g_checks.fill(FakeCheck{});
    AssumptionMonitor sut(kAssumptions);

    for (std::int64_t at = 0; at < 5; ++at) {
        EXPECT_EQ(sut.step(Instant{at}), SelfTestStatus::kPassed);
    }
    for (const FakeCheck& check : g_checks) {
        EXPECT_EQ(check.calls, 5U);
    }
}

TEST(AllAssumptionsTest, RowsSayWhatTheyWereGiven) {
    verifies("SWR-AOU-002");
    const AssumptionRow row = assume(Assumption::kBudget, "budget", g_checks[4], Duration{300});

    EXPECT_TRUE((checks_all<kAssumptions, Assumption::kCount>()));
    EXPECT_EQ(row.assumption, 4U);
    EXPECT_EQ(row.check, &g_checks[4]);
    EXPECT_EQ(row.within, Duration{300});
    EXPECT_EQ(std::string(row.name), "budget");
}

TEST(AllAssumptionsTest, OfSeveralFailuresTheFirstRowIsNamed) {
    verifies("SWR-AOU-001", Technique::kFaultInjection, Polarity::kViolation);
    g_checks.fill(FakeCheck{});
    g_checks[4].answer = SelfTestStatus::kFailed;
    g_checks[2].answer = SelfTestStatus::kFailed;
    AssumptionMonitor sut(kAssumptions);

    EXPECT_EQ(sut.step(Instant{0}), SelfTestStatus::kFailed);
    EXPECT_EQ(sut.get_failed(), static_cast<AssumptionIndex>(Assumption::kMemoryProtection));
}

TEST(AllAssumptionsTest, EmptyTableGoesToTheAssertionHandler) {
    verifies("SWR-AOU-001", Technique::kBoundaryValues, Polarity::kViolation);

    EXPECT_CHECK_FAILS(AssumptionMonitor{Span<const AssumptionRow>{}}, "assumption_monitor.hpp", 1);
}

/// The whole chain as the manual shows it: real tests, a schedule, a monitor, the safe-state machine.
class StartTest : public ::testing::Test {
  protected:
    StartTest() { g_checks.fill(FakeCheck{}); }
    /// @return state after a pass of all tests and a push of the start button.
    SafeState start() {
        SafeStateInputs inputs;
        inputs.demand = Reaction::kNone;
        inputs.faults_cleared = true;
        inputs.standstill = true;
        inputs.start_permitted = true;
        EXPECT_EQ(schedule_.start(Instant{0}, Duration{10}), Status::kOk);
        for (std::size_t i = 0U; i < schedule_.calc_step_count() + 2U; ++i) {
            inputs.now = Instant{static_cast<std::int64_t>(i) * 10};
            inputs.self_test = combine(schedule_.step(inputs.now), monitor_.step(inputs.now));
            inputs.start_button = machine_.get_state() == SafeState::kStandby;
            static_cast<void>(machine_.step(inputs));
        }
        return machine_.get_state();
    }

    std::array<std::uint32_t, 8U> memory_{};
    RamArea reserved_{memory_.data(), memory_.size()};
    RamMarch<RamArea> march_{reserved_, 50U};
    std::array<std::byte, 9U> table_{};
    RegionCrc constants_{{table_.data(), table_.size()}, 0xE60914AEU, 4U};  // CRC-32 of nine zero bytes
    CpuCheck<NativeCpu> cpu_{};
    std::array<SelfTest*, 3U> tests_{{&march_, &constants_, &cpu_}};
    SelfTestSchedule schedule_{{tests_.data(), tests_.size()}, Duration{1000}};
    AssumptionMonitor monitor_{kAssumptions};
    SafeStateMachine machine_{{Duration{100}, Duration{100}}};
};

TEST_F(StartTest, MachineBecomesOperationalWhenEverythingHolds) {
    verifies("SWR-AOU-001", Technique::kInterface);

    EXPECT_EQ(start(), SafeState::kOperational);
}

TEST_F(StartTest, MachineWithAChangedConstantDoesNot) {
    verifies("SWR-AOU-001", Technique::kInterface, Polarity::kViolation);
    table_[3] = std::byte{1U};
    EXPECT_EQ(start(), SafeState::kLockedOut);
    EXPECT_EQ(schedule_.get_failure(), SelfTestFailure::kFault);
    EXPECT_EQ(schedule_.get_test(), 1U);
}

TEST_F(StartTest, MachineWhoseWatchdogIsMissingDoesNot) {
    verifies("SWR-AOU-001", Technique::kInterface, Polarity::kViolation);
    g_checks[1].answer = SelfTestStatus::kFailed;

    EXPECT_EQ(start(), SafeState::kLockedOut);
    EXPECT_EQ(std::string(monitor_.get_failed_name()), "watchdog");
}

TEST(CombineTest, WorstResultCounts) {
    verifies("SWR-AOU-001", Technique::kEquivalenceClasses);
    constexpr auto kRunning = SelfTestStatus::kRunning;
    constexpr auto kPassed = SelfTestStatus::kPassed;
    constexpr auto kFailed = SelfTestStatus::kFailed;
    constexpr auto kCorrupted = static_cast<SelfTestStatus>(77);

    EXPECT_EQ(combine(kRunning, kRunning), kRunning);
    EXPECT_EQ(combine(kRunning, kPassed), kRunning);
    EXPECT_EQ(combine(kPassed, kRunning), kRunning);
    EXPECT_EQ(combine(kPassed, kPassed), kPassed);
    for (const SelfTestStatus other : {kRunning, kPassed, kFailed, kCorrupted}) {
        for (const SelfTestStatus bad : {kFailed, kCorrupted}) {
            EXPECT_EQ(combine(bad, other), kFailed);
            EXPECT_EQ(combine(other, bad), kFailed);
        }
    }
}

}  // namespace
}  // namespace mamori::safety
