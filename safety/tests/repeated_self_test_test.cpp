// SPDX-License-Identifier: Apache-2.0
// Goal: the self tests of a table run from power-up on, find a lasting fault within the stated time, and lead
// to the reaction of the table. Method: a table with two checks, whose steps a test writes or takes from real
// checks; each begin of a fault within a pass.
#include <gtest/gtest.h>

#include "mamori/safety/self_test/march.hpp"
#include "mamori/safety/self_test/region_crc.hpp"
#include "safety_cycle_fixture.hpp"

namespace mamori::safety::testing_of_cycle {
namespace {

enum class Memory : FaultIndex { kLate, kStartUp, kBrake, kConstants, kData };
constexpr std::int64_t kPassMax = 20;  ///< cycles, half of the stated time
constexpr Duration kFound{2 * kPassMax * kFrame.ns};

/// Results that the test states step by step, or the steps of another check.
class Check final : public SelfTest {
  public:
    void begin() noexcept override {
        ++begins;
        step_in_pass_ = 0U;
        if (inner != nullptr) {
            inner->begin();
        }
    }
    SelfTestStatus step() noexcept override {
        ++steps;
        ++step_in_pass_;
        if (inner != nullptr) {
            return inner->step();
        }
        if (is_failing) {
            return SelfTestStatus::kFailed;
        }
        return step_in_pass_ == length ? SelfTestStatus::kPassed : SelfTestStatus::kRunning;
    }
    std::size_t get_step_count() const noexcept override {
        return inner != nullptr ? inner->get_step_count() : length;
    }

    SelfTest* inner{nullptr};
    std::size_t length{1U};
    bool is_failing{false};
    int begins{0};
    int steps{0};

  private:
    std::size_t step_in_pass_{0U};
};

Check g_constants;
Check g_data;
Decider g_cycle{"cycle"};
Sensor g_eyes{"eyes"};
constexpr auto kTested = safety::system(
    frame(kFrame), window("all", 0_us, kFrame, budget(kFrame), run(g_eyes, g_cycle)),
    connect(g_eyes.seen, g_cycle.seen, any_age()),
    faults<Memory::kLate, Memory::kStartUp, Memory::kBrake, Memory::kConstants, Memory::kData>(),
    react(Memory::kLate, Reaction::kSto, within(1_ms)), react(Memory::kStartUp, Reaction::kSto, within(2_ms)),
    react(Memory::kBrake, Reaction::kSs1, within(2_ms)),
    react(Memory::kConstants, Reaction::kSs1, within(2_ms)),
    react(Memory::kData, Reaction::kDegrade, within(2_ms)), supervise(g_cycle, alive(), deadline(100_us)),
    supervise(g_eyes, alive(), deadline(100_us)),
    confirmed_by(g_eyes.seen, StopConfirmation::kStandstill, StopConfirmation::kClosedBrakes,
                 StopConfirmation::kTorqueOff),
    self_test(g_constants, found_within(kFound), raises(Memory::kConstants)),
    self_test(g_data, found_within(kFound), raises(Memory::kData)),
    cycle(StopBounds{20_ms, 20_ms}, BrakeLimits{10_ms, true}, WatchdogWindow{500_us, 4_ms},
          torque_feedback(kTorqueFeedback), tolerated_lateness(50_us),
          on_late_reaction(raises(Memory::kLate)), on_failed_self_test(raises(Memory::kStartUp)),
          on_unconfirmed_brakes(raises(Memory::kBrake))));
MAMORI_SAFETY_CHECK(kTested);

/// One power-up.
struct Machine {
    Status initialize() {
        sut.inputs.is_standing = true;
        sut.inputs.are_brakes_closed = true;
        sut.inputs.may_start = true;
        return sut.initialize();
    }
    SafeState step() {
        state.get_observer().get_records()[0U].note_run(now, now + 10_us);
        state.get_observer().get_records()[1U].note_run(now, now + 10_us);
        EXPECT_EQ(sut.on_execute({0, now}), Status::kOk);
        sut.inputs.applied = sut.outputs;
        sut.inputs.has_torque = sut.outputs.torque_enable;
        sut.inputs.are_brakes_closed = !sut.outputs.brake_release;
        now = now + kFrame;
        return sut.get_state();
    }
    void step(std::int64_t cycles) {
        for (std::int64_t i = 0; i < cycles; ++i) {
            step();
        }
    }
    void operate() {
        for (std::int64_t i = 0; i < 2 * kPassMax && sut.get_state() != SafeState::kStandby; ++i) {
            step();
        }
        sut.inputs.start_button = true;
        step();
        sut.inputs.start_button = false;
        ASSERT_EQ(step(), SafeState::kOperational);
    }
    bool is_latched(Memory fault) const {
        return state.get_faults().is_latched(static_cast<FaultIndex>(fault));
    }
    /// @return number of cycles until the fault is latched; 3 passes if no fault is latched.
    std::int64_t count_until_latched(Memory fault) {
        for (std::int64_t i = 1; i < 3 * kPassMax; ++i) {
            step();
            if (is_latched(fault)) {
                return i;
            }
        }
        return 3 * kPassMax;
    }

    SafetyStorage<kTested> storage{};
    SpyWatchdog watchdog{};
    SafetyState state{storage, watchdog};
    std::array<Event, 32U> events{};
    EventLog log{events};
    FakeMachine sut{state, &log};
    Instant now{};
};

class RepeatedSelfTestTest : public ::testing::Test {
  protected:
    RepeatedSelfTestTest() {
        g_constants = Check{};
        g_data = Check{};
    }
    Machine machine_{};
};

TEST_F(RepeatedSelfTestTest, EachCheckDoesOneStepInEachCycle) {
    verifies("SWR-CYC-020");
    g_constants.length = 3U;
    ASSERT_EQ(machine_.initialize(), Status::kOk);
    const int begins = g_constants.begins;

    for (int i = 1; i <= 9; ++i) {
        machine_.step();
        EXPECT_EQ(g_constants.steps, i);
        EXPECT_EQ(g_data.steps, i);
    }
    EXPECT_EQ(g_constants.begins, begins + 1 + 3) << "at power-up, and after each of three passes";
    EXPECT_EQ(machine_.state.get_self_tests()[0U].get_pass_count(), 3U);
    EXPECT_EQ(machine_.state.get_self_tests()[1U].get_pass_count(), 9U);
}

TEST_F(RepeatedSelfTestTest, AFailureLeadsToTheReactionOfItsFault) {
    verifies("SWR-CYC-020", Technique::kFaultInjection, Polarity::kViolation);
    ASSERT_EQ(machine_.initialize(), Status::kOk);
    machine_.operate();
    g_data.is_failing = true;

    EXPECT_EQ(machine_.step(), SafeState::kDegraded) << "in the cycle that finds it";
    EXPECT_TRUE(machine_.is_latched(Memory::kData));
    EXPECT_FALSE(machine_.is_latched(Memory::kConstants));
    EXPECT_FALSE(machine_.is_latched(Memory::kStartUp)) << "the start-up test has not failed";
    g_constants.is_failing = true;
    EXPECT_EQ(machine_.step(), SafeState::kProtectiveStopSs1) << "the other check continues";
    EXPECT_TRUE(machine_.is_latched(Memory::kConstants));
}

TEST_F(RepeatedSelfTestTest, AFailureIsFinalAndOneEvent) {
    verifies("SWR-CYC-020", Technique::kStateTransition, Polarity::kViolation);
    ASSERT_EQ(machine_.initialize(), Status::kOk);
    machine_.operate();
    g_constants.is_failing = true;
    machine_.step();
    g_constants.is_failing = false;

    for (int i = 0; i < 50; ++i) {
        machine_.sut.inputs.reset_button = i % 2 == 1;
        machine_.step();
        ASSERT_TRUE(machine_.is_latched(Memory::kConstants)) << i;
    }
    std::size_t count = 0U;
    for (std::size_t i = 0U; i < machine_.log.size(); ++i) {
        if (machine_.log.get(i).code == static_cast<std::uint16_t>(CycleEvent::kSelfTestFailed)) {
            EXPECT_EQ(machine_.log.get(i).argument, 0);
            ++count;
        }
    }
    EXPECT_EQ(count, 1U);
    EXPECT_EQ(machine_.state.get_self_tests()[0U].get_failure(), SelfTestFailure::kFault);
}

TEST_F(RepeatedSelfTestTest, StepsThatFitAreAccepted) {
    verifies("SWR-CYC-021", Technique::kBoundaryValues);
    g_constants.length = kPassMax;
    ASSERT_EQ(machine_.initialize(), Status::kOk);

    machine_.step(10 * kPassMax);
    EXPECT_EQ(machine_.state.get_faults().get_latched_count(), 0U);
    EXPECT_EQ(machine_.state.get_self_tests()[0U].get_pass_count(), 10U);
}

TEST_F(RepeatedSelfTestTest, OneStepTooManyIsRejectedAtTheInitialisation) {
    verifies("SWR-CYC-021", Technique::kBoundaryValues, Polarity::kViolation);
    g_constants.length = kPassMax + 1;

    EXPECT_EQ(machine_.initialize(), Status::kBadParameter);
}

TEST_F(RepeatedSelfTestTest, APassThatTakesTooLongIsAFault) {
    verifies("SWR-CYC-021", Technique::kFaultInjection, Polarity::kViolation);
    g_constants.length = kPassMax;
    ASSERT_EQ(machine_.initialize(), Status::kOk);
    machine_.operate();
    machine_.now = machine_.now + 2_ms;  // cycles are missing

    EXPECT_LE(machine_.count_until_latched(Memory::kConstants), kPassMax);
    EXPECT_EQ(machine_.state.get_self_tests()[0U].get_failure(), SelfTestFailure::kOverdue);
}

TEST_F(RepeatedSelfTestTest, EachTurnedBitIsFoundInTimeWheneverItTurns) {
    verifies("SWR-CYC-021", Technique::kFaultInjection, Polarity::kViolation);
    std::int64_t longest = 0;
    for (std::int64_t begin = 0; begin < kPassMax; ++begin) {
        for (std::size_t place = 0U; place < kPassMax; ++place) {
            std::array<std::uint8_t, kPassMax> constants{};
            RegionCrc crc{constants, 1U};
            g_constants.inner = &crc;
            Machine machine;
            ASSERT_EQ(machine.initialize(), Status::kOk);
            machine.operate();
            machine.step(begin);

            constants[place] = static_cast<std::uint8_t>(1U << (place % 8U));
            const std::int64_t cycles = machine.count_until_latched(Memory::kConstants);
            longest = cycles > longest ? cycles : longest;
            ASSERT_TRUE(machine.sut.get_state() == SafeState::kProtectiveStopSs1);
        }
    }
    EXPECT_LT(longest, 2 * kPassMax);
    EXPECT_EQ(longest, 2 * kPassMax - 1) << "a byte that turns after it was read first";
}

/// One bit of a word can stick at 1.
struct StickingMemory {
    using Word = std::uint8_t;
    std::size_t size() const { return cells.size(); }
    Word read(std::size_t index) const { return cells[index]; }
    void write(std::size_t index, Word value) {
        cells[index] = static_cast<Word>(value | (index == stuck_at ? 4U : 0U));
    }
    std::array<Word, 6U> cells{};
    std::size_t stuck_at{6U};
};

TEST_F(RepeatedSelfTestTest, AStuckBitOfLiveDataIsFoundInTime) {
    verifies("SWR-CYC-021", Technique::kFaultInjection, Polarity::kViolation);
    for (std::int64_t begin = 0; begin < kPassMax; ++begin) {
        for (std::size_t place = 0U; place < 6U; ++place) {
            StickingMemory memory;
            TransparentMarch<StickingMemory, 2U> march{memory};
            ASSERT_EQ(march.get_step_count(), static_cast<std::size_t>(kPassMax));
            g_data.inner = &march;
            Machine machine;
            ASSERT_EQ(machine.initialize(), Status::kOk);
            machine.operate();
            machine.step(begin);

            memory.stuck_at = place;
            ASSERT_LT(machine.count_until_latched(Memory::kData), 2 * kPassMax);
            ASSERT_EQ(machine.sut.get_state(), SafeState::kDegraded);
        }
    }
}

TEST_F(RepeatedSelfTestTest, TheMachineWaitsForTheFirstPassOfEachCheck) {
    verifies("SWR-CYC-022");
    g_constants.length = 7U;
    g_data.length = kPassMax;
    ASSERT_EQ(machine_.initialize(), Status::kOk);

    for (std::int64_t i = 1; i < kPassMax; ++i) {
        ASSERT_EQ(machine_.step(), SafeState::kSelfTest) << i;
    }
    EXPECT_EQ(machine_.step(), SafeState::kStandby);
}

TEST_F(RepeatedSelfTestTest, AFailureInTheFirstPassPreventsTheStart) {
    verifies("SWR-CYC-022", Technique::kFaultInjection, Polarity::kViolation);
    g_data.is_failing = true;
    ASSERT_EQ(machine_.initialize(), Status::kOk);

    for (int i = 0; i < 60; ++i) {
        machine_.sut.inputs.start_button = i % 2 == 1;
        ASSERT_NE(machine_.step(), SafeState::kOperational);
        ASSERT_FALSE(machine_.sut.outputs.torque_enable);
    }
    EXPECT_TRUE(machine_.is_latched(Memory::kData));
}

}  // namespace
}  // namespace mamori::safety::testing_of_cycle
