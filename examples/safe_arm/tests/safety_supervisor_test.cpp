// SPDX-License-Identifier: Apache-2.0
// Goal: one place turns observations into the declared reaction, starts only on purpose, and serves the
// watchdog on proven health only. Method: frame after frame with readings, monitor results and component runs
// made here.
#include "safety_supervisor.hpp"

#include <cstddef>
#include <cstring>

#include "feed.hpp"
#include "mamori/verification/verifies.hpp"

namespace safe_arm {
namespace {

using mamori::Duration;
using mamori::Instant;
using mamori::Status;
using mamori::safety::SafeState;
using mamori::safety::SelfTestStatus;
using mamori::verification::Polarity;
using mamori::verification::Technique;
using mamori::verification::verifies;

constexpr std::size_t kOther = 0U;
constexpr std::size_t kController = 1U;

class SpyWatchdog final : public mamori::safety::Watchdog {
  public:
    Status service(Instant) noexcept override {
        services += answer == Status::kOk ? 1 : 0;
        return answer;
    }
    int services{0};
    Status answer{Status::kOk};
};

/// An assumption of use whose check answers as the test says.
class FakeCheck final : public mamori::safety::AssumptionCheck {
  public:
    mamori::safety::SelfTestStatus check() noexcept override { return answer; }
    mamori::safety::SelfTestStatus answer{mamori::safety::SelfTestStatus::kPassed};
};
FakeCheck g_sound;
FakeCheck g_check;
enum class Assumption : mamori::safety::AssumptionIndex { kSound, kChecked, kCount };
constexpr std::array kAssumptions{
    mamori::safety::assume(Assumption::kSound, "sound", g_sound, kSelfTestTime),
    mamori::safety::assume(Assumption::kChecked, "checked", g_check, kSelfTestTime)};
static_assert(mamori::safety::checks_all<kAssumptions, Assumption::kCount>());

class SafetySupervisorTest : public ::testing::Test {
  protected:
    void SetUp() override {
        using mamori::safety::SupervisionScope;
        g_check.answer = SelfTestStatus::kPassed;
        const mamori::safety::DeadlineLimits deadline{Duration{0}, kSafetyComponentMax};
        ASSERT_EQ(supervision_.watch(kOther, {kAliveLimits, deadline, SupervisionScope::kGlobal}),
                  Status::kOk);
        ASSERT_EQ(supervision_.watch(kController, {kAliveLimits, deadline, SupervisionScope::kLocal}),
                  Status::kOk);
        ASSERT_EQ(sut_.initialize(), Status::kOk);
        reading_.power_good = true;
        reading_.brakes_closed = true;
        state_.is_standing = true;
        state_.is_setpoint_near = true;
    }

    /// One frame: the components run as `is_other_running_` and `is_controller_running_` say, then the
    /// supervisor decides.
    StopCommand step() {
        if (is_other_running_) {
            supervision_.get_records()[kOther].note_run(now_, now_ + 10_us);
        }
        if (is_controller_running_) {
            supervision_.get_records()[kController].note_run(now_, now_ + 10_us);
        }
        if (is_reader_running_) {
            feed(sut_.reading, reading_);
        }
        if (is_monitor_running_) {
            feed(sut_.arm_state, state_);
        }
        EXPECT_EQ(sut_.on_execute({0, now_}), Status::kOk);
        sut_.reading.mark_read();
        sut_.arm_state.mark_read();
        now_ = now_ + kFrame;
        return take(sut_.stop);
    }
    StopCommand step_until(SafeState wanted, int frames_max) {
        StopCommand command{};
        for (int i = 0; i < frames_max && sut_.get_state() != wanted; ++i) {
            command = step();
        }
        return command;
    }
    StopCommand operate() {
        step_until(SafeState::kStandby, 100);
        reading_.start_button = true;
        StopCommand command = step();
        reading_.start_button = false;
        reading_.brakes_closed = false;
        reading_.torque_enabled = true;
        return command;
    }

    mamori::safety::ExecutionStorage<2U> storage_;
    mamori::safety::ExecutionSupervisor supervision_{storage_, kLatenessMax};
    std::array<mamori::Event, 32U> events_{};
    mamori::EventLog log_{events_};
    SpyWatchdog watchdog_;
    mamori::safety::AssumptionMonitor assumptions_{kAssumptions};
    DecisionFlow flow_;
    SafetySupervisor sut_{supervision_, kController, watchdog_, log_, assumptions_, flow_};
    JointReading reading_{};
    JointState state_{};
    Instant now_{};
    bool is_reader_running_{true};
    bool is_monitor_running_{true};
    bool is_other_running_{true};
    bool is_controller_running_{true};
};

TEST_F(SafetySupervisorTest, PassedSelfTestAndDeliberateStartLeadToOperation) {
    verifies("SWR-SAF-014", Technique::kStateTransition);

    const StopCommand command = operate();
    EXPECT_EQ(command.state, SafeState::kOperational);
    EXPECT_TRUE(command.torque_enable);
    EXPECT_TRUE(command.brake_release);
}

TEST_F(SafetySupervisorTest, SelfTestNeedsItsGoodFramesInARow) {
    verifies("SWR-SAF-014", Technique::kBoundaryValues, Polarity::kViolation);
    for (std::uint32_t i = 0U; i < kSelfTestFrames; ++i) {
        ASSERT_EQ(step().state, SafeState::kSelfTest) << "the first frame is not good: no service before it";
    }
    reading_.brakes_closed = false;
    EXPECT_EQ(step().state, SafeState::kSelfTest);
    reading_.brakes_closed = true;
    for (std::uint32_t i = 1U; i < kSelfTestFrames; ++i) {
        ASSERT_EQ(step().state, SafeState::kSelfTest) << i;
    }
    EXPECT_EQ(step().state, SafeState::kStandby);
}

TEST_F(SafetySupervisorTest, SelfTestThatNeverPassesLocksOut) {
    verifies("SWR-SAF-014", Technique::kFaultInjection, Polarity::kViolation);
    reading_.brakes_closed = false;

    step_until(SafeState::kLockedOut, 600);
    EXPECT_EQ(sut_.get_state(), SafeState::kLockedOut);
    EXPECT_EQ(sut_.get_first_fault(), to_index(ArmFault::kSelfTestFailed));
}

TEST_F(SafetySupervisorTest, SelfTestDoesNotPassBeforeTheWatchdogIsServed) {
    verifies("SWR-SAF-014", Technique::kFaultInjection, Polarity::kViolation);
    // A watchdog that was never served has not begun to watch: nothing would open the relay.
    supervision_.on_budget_overrun(0U, kOther, now_);

    step_until(SafeState::kStandby, 600);
    EXPECT_EQ(watchdog_.services, 0);
    EXPECT_EQ(sut_.get_state(), SafeState::kLockedOut);
}

TEST_F(SafetySupervisorTest, StartIsRefusedWhileTheWatchdogIsNotServed) {
    verifies("SWR-SAF-014", Technique::kFaultInjection, Polarity::kViolation);
    step_until(SafeState::kStandby, 100);
    watchdog_.answer = Status::kError;
    step();

    reading_.start_button = true;
    EXPECT_EQ(step().state, SafeState::kStandby);
}

TEST_F(SafetySupervisorTest, StartIsRefusedWithoutItsPreconditions) {
    verifies("SWR-SAF-014", Technique::kErrorGuessing, Polarity::kViolation);
    reading_.start_button = true;
    step_until(SafeState::kStandby, 100);
    EXPECT_EQ(step().state, SafeState::kStandby) << "held since power-up: no edge";
    reading_.start_button = false;
    step();
    state_.is_setpoint_near = false;
    reading_.start_button = true;
    EXPECT_EQ(step().state, SafeState::kStandby) << "setpoint away from the measured position";
    state_.is_setpoint_near = true;
    EXPECT_EQ(step().state, SafeState::kStandby) << "the push of the frame before counts for nothing";
}

TEST_F(SafetySupervisorTest, FaultStopsTorqueInTheSameFrameAndStaysLatched) {
    verifies("SWR-SAF-013", Technique::kFaultInjection, Polarity::kViolation);
    operate();

    state_.faults = to_bit(ArmFault::kPowerLost);
    EXPECT_FALSE(step().torque_enable);
    EXPECT_EQ(sut_.get_state(), SafeState::kSafe);
    state_.faults = 0U;
    EXPECT_EQ(step().state, SafeState::kSafe);
    EXPECT_EQ(sut_.get_first_fault(), to_index(ArmFault::kPowerLost));
    EXPECT_EQ(sut_.get_reaction(), Reaction::kSto);
}

TEST_F(SafetySupervisorTest, FaultFreeOperationGoesOn) {
    verifies("SWR-SAF-013");
    operate();

    for (int i = 0; i < 100; ++i) {
        EXPECT_EQ(step().state, SafeState::kOperational);
    }
    EXPECT_EQ(sut_.get_reaction(), Reaction::kNone);
}

TEST_F(SafetySupervisorTest, FaultIsLatchedAfterItsConfirmationAndNotBefore) {
    verifies("SWR-SAF-013", Technique::kBoundaryValues, Polarity::kViolation);
    operate();
    state_.faults = to_bit(ArmFault::kTorqueDeviation);
    step();
    ASSERT_EQ(step().state, SafeState::kOperational);
    state_.faults = 0U;
    step();
    state_.faults = to_bit(ArmFault::kTorqueDeviation);
    step();
    ASSERT_EQ(step().state, SafeState::kOperational);

    EXPECT_EQ(step().state, SafeState::kSafe);
}

TEST_F(SafetySupervisorTest, ControlledStopEndsSafeWhenItIsConfirmed) {
    verifies("SWR-SAF-013", Technique::kStateTransition);
    operate();
    state_.is_standing = false;
    state_.faults = to_bit(ArmFault::kEncoderImplausible);
    const StopCommand command = step();
    EXPECT_EQ(command.state, SafeState::kProtectiveStopSs1);
    EXPECT_TRUE(command.torque_enable);
    EXPECT_TRUE(command.stop_requested);

    state_.is_standing = true;
    reading_.brakes_closed = true;
    EXPECT_EQ(step().state, SafeState::kSafe);
}

TEST_F(SafetySupervisorTest, BrakesCloseUnderTorqueBeforeItIsSwitchedOff) {
    verifies("SWR-SAF-018", Technique::kStateTransition);
    operate();
    state_.is_standing = false;
    state_.faults = to_bit(ArmFault::kEncoderImplausible);
    EXPECT_TRUE(step().brake_release);

    state_.is_standing = true;
    const StopCommand closing = step();
    EXPECT_EQ(closing.state, SafeState::kProtectiveStopSs1);
    EXPECT_TRUE(closing.torque_enable);
    EXPECT_FALSE(closing.brake_release);
    state_.is_standing = false;
    EXPECT_FALSE(step().brake_release) << "a twitch does not open them again";
    state_.is_standing = true;
    reading_.brakes_closed = true;
    EXPECT_FALSE(step().torque_enable);
}

TEST_F(SafetySupervisorTest, BrakesThatNeverReportEndInTorqueOffAtTheBound) {
    verifies("SWR-SAF-018", Technique::kFaultInjection, Polarity::kViolation);
    operate();
    state_.faults = to_bit(ArmFault::kEncoderImplausible);
    const auto bound = kStopBounds.ss1_within.ns / kFrame.ns;
    for (std::int64_t i = 0; i < bound; ++i) {
        ASSERT_TRUE(step().torque_enable) << i;
    }

    const StopCommand command = step();
    EXPECT_EQ(command.state, SafeState::kSafe);
    EXPECT_FALSE(command.torque_enable);
}

TEST_F(SafetySupervisorTest, ControlledStopThatIsIgnoredBecomesTorqueOff) {
    verifies("SWR-SAF-013", Technique::kFaultInjection, Polarity::kViolation);
    operate();
    state_.is_standing = false;
    state_.faults = to_bit(ArmFault::kEncoderImplausible);
    const auto bound = kStopBounds.ss1_within.ns / kFrame.ns;
    for (std::int64_t i = 0; i < bound; ++i) {
        ASSERT_EQ(step().state, SafeState::kProtectiveStopSs1) << i;
    }

    EXPECT_EQ(step().state, SafeState::kSafe);
}

TEST_F(SafetySupervisorTest, SeverestOfSeveralFaultsDecides) {
    verifies("SWR-SAF-013", Technique::kEquivalenceClasses, Polarity::kViolation);
    operate();
    state_.is_standing = false;

    state_.faults = to_bit(ArmFault::kEncoderImplausible) | to_bit(ArmFault::kFollowingError);
    EXPECT_EQ(step().state, SafeState::kSafe);
}

TEST_F(SafetySupervisorTest, SilentControllerIsAFaultAndLeavesTheWatchdogServed) {
    verifies("SWR-SAF-013", Technique::kFaultInjection, Polarity::kViolation);
    operate();
    is_controller_running_ = false;
    supervision_.on_budget_overrun(1U, kController, now_);
    const int before = watchdog_.services;

    EXPECT_EQ(step().state, SafeState::kSafe);
    EXPECT_EQ(sut_.get_first_fault(), to_index(ArmFault::kControllerSilent));
    EXPECT_EQ(watchdog_.services, before + 1);
}

TEST_F(SafetySupervisorTest, ReaderThatFallsSilentStopsTorqueInItsFrame) {
    verifies("SWR-SAF-019", Technique::kFaultInjection, Polarity::kViolation);
    operate();

    is_reader_running_ = false;
    EXPECT_FALSE(step().torque_enable);
    EXPECT_EQ(sut_.get_first_fault(), to_index(ArmFault::kMeasurementStale));
}

TEST_F(SafetySupervisorTest, MonitorThatFallsSilentStopsTorqueInItsFrame) {
    verifies("SWR-SAF-019", Technique::kFaultInjection, Polarity::kViolation);
    operate();

    is_monitor_running_ = false;
    EXPECT_FALSE(step().torque_enable) << "what was judged a frame ago says nothing";
    EXPECT_EQ(sut_.get_first_fault(), to_index(ArmFault::kMeasurementStale));
}

TEST_F(SafetySupervisorTest, MeasurementOfEachFrameIsNoFault) {
    verifies("SWR-SAF-019");
    operate();

    for (int i = 0; i < 100; ++i) {
        ASSERT_EQ(step().state, SafeState::kOperational) << i;
    }
}

TEST_F(SafetySupervisorTest, ResetBringsTheMachineBackOnlyWhenTheFaultIsGone) {
    verifies("SWR-SAF-013", Technique::kStateTransition, Polarity::kViolation);
    operate();
    state_.faults = to_bit(ArmFault::kOverspeed);
    step_until(SafeState::kSafe, 10);
    reading_.torque_enabled = false;
    reading_.brakes_closed = true;
    reading_.reset_button = true;
    EXPECT_EQ(step().state, SafeState::kSafe) << "still present";
    state_.faults = 0U;
    EXPECT_EQ(step().state, SafeState::kSafe) << "no new push";

    reading_.reset_button = false;
    step();
    reading_.reset_button = true;
    EXPECT_EQ(step().state, SafeState::kSelfTest);
}

TEST_F(SafetySupervisorTest, OnePushBringsTheMachineBackOnceTheControllerRunsAgain) {
    verifies("SWR-SAF-013", Technique::kStateTransition);
    operate();
    supervision_.on_budget_overrun(1U, kController, now_);
    step();
    reading_.torque_enabled = false;
    reading_.brakes_open = false;
    reading_.brakes_closed = true;
    for (int i = 0; i < 5; ++i) {
        supervision_.on_budget_overrun(1U, kController, now_);
        reading_.reset_button = i == 3;
        ASSERT_EQ(step().state, SafeState::kSafe) << "still hanging, push in frame 3";
    }

    step();
    reading_.reset_button = true;
    EXPECT_EQ(step().state, SafeState::kSelfTest);
}

TEST_F(SafetySupervisorTest, WatchdogIsServedWhileTheSafetyPartitionIsHealthy) {
    verifies("SWR-SAF-015");
    for (int i = 1; i <= 50; ++i) {
        step();
        EXPECT_EQ(watchdog_.services, i);
    }
}

TEST_F(SafetySupervisorTest, WatchdogIsNotServedOnceASafetyComponentFailed) {
    verifies("SWR-SAF-015", Technique::kFaultInjection, Polarity::kViolation);
    operate();
    supervision_.on_budget_overrun(0U, kOther, now_);
    const int before = watchdog_.services;
    step();
    EXPECT_EQ(watchdog_.services, before);
    step();
    EXPECT_EQ(watchdog_.services, before) << "running again does not help";
}

TEST_F(SafetySupervisorTest, TorqueThatCannotBeSwitchedOffIsLeftToTheWatchdog) {
    verifies("SWR-SAF-015", Technique::kFaultInjection, Polarity::kViolation);
    operate();
    state_.faults = to_bit(ArmFault::kPowerLost);
    step();
    const auto tolerated = kTorqueFeedbackTime.ns / kFrame.ns;
    for (std::int64_t i = 0; i < tolerated; ++i) {
        ASSERT_EQ(step().state, SafeState::kSafe) << i;
    }
    const int before = watchdog_.services;

    EXPECT_EQ(step().state, SafeState::kLockedOut);
    EXPECT_EQ(watchdog_.services, before);
}

// ---- Assumptions of use ----

TEST_F(SafetySupervisorTest, SelfTestPassesOnceTheAssumptionsHold) {
    verifies("SWR-SAF-021", Technique::kStateTransition);
    g_check.answer = SelfTestStatus::kRunning;
    for (std::uint32_t i = 0U; i < 2U * kSelfTestFrames; ++i) {
        ASSERT_EQ(step().state, SafeState::kSelfTest) << "not known yet, frame " << i;
    }

    g_check.answer = SelfTestStatus::kPassed;
    EXPECT_EQ(step().state, SafeState::kStandby);
    EXPECT_EQ(log_.size(), 1U) << "no event but the state";
}

TEST_F(SafetySupervisorTest, AssumptionThatIsNeverKnownToHoldLocksOut) {
    verifies("SWR-SAF-021", Technique::kBoundaryValues, Polarity::kViolation);
    g_check.answer = SelfTestStatus::kRunning;

    step_until(SafeState::kLockedOut, 600);
    EXPECT_EQ(sut_.get_state(), SafeState::kLockedOut);
}

TEST_F(SafetySupervisorTest, AssumptionThatIsLostWhileTheArmMovesTakesTorqueAndIsNamedOnce) {
    verifies("SWR-SAF-021", Technique::kFaultInjection, Polarity::kViolation);
    operate();
    ASSERT_EQ(step().state, SafeState::kOperational);

    g_check.answer = SelfTestStatus::kFailed;
    const StopCommand command = step();
    EXPECT_EQ(command.state, SafeState::kLockedOut);
    EXPECT_FALSE(command.torque_enable);
    EXPECT_FALSE(command.brake_release);
    EXPECT_EQ(sut_.get_first_fault(), to_index(ArmFault::kSelfTestFailed));
    step();
    std::size_t named = 0U;
    for (std::size_t i = 0U; i < log_.size(); ++i) {
        if (log_.get(i).code == static_cast<std::uint16_t>(ArmEvent::kAssumptionFailed)) {
            EXPECT_EQ(log_.get(i).argument, static_cast<std::int64_t>(Assumption::kChecked));
            ++named;
        }
    }
    EXPECT_EQ(named, 1U);
}

// ---- Order of its own steps ----

TEST_F(SafetySupervisorTest, WatchdogIsServedWhileEachFrameBeginsJudgesAndCommands) {
    verifies("SWR-SAF-022");
    for (int i = 1; i <= 100; ++i) {
        step();
        ASSERT_EQ(watchdog_.services, i);
    }
    EXPECT_EQ(flow_.supervisor.get_status(), mamori::safety::SupervisionStatus::kOk);
}

TEST_F(SafetySupervisorTest, WatchdogIsNotServedOnceAStepCameOutOfItsOrder) {
    verifies("SWR-SAF-022", Technique::kFaultInjection, Polarity::kViolation);
    for (const FlowPoint point : {FlowPoint::kBegun, FlowPoint::kJudged, FlowPoint::kCommanded}) {
        SpyWatchdog watchdog;
        DecisionFlow flow;
        mamori::safety::AssumptionMonitor assumptions{kAssumptions};
        SafetySupervisor sut{supervision_, kController, watchdog, log_, assumptions, flow};
        ASSERT_EQ(sut.initialize(), Status::kOk);
        ASSERT_EQ(sut.on_execute({0, now_}), Status::kOk);
        ASSERT_EQ(watchdog.services, 1) << static_cast<int>(point);

        flow.report(point, now_ + 1_us);  // control flow that came to a step from nowhere
        for (int i = 0; i < 3; ++i) {
            now_ = now_ + kFrame;
            supervision_.get_records()[kOther].note_run(now_, now_ + 10_us);
            supervision_.get_records()[kController].note_run(now_, now_ + 10_us);
            ASSERT_EQ(sut.on_execute({0, now_}), Status::kOk);
        }
        EXPECT_EQ(watchdog.services, 1) << static_cast<int>(point) << ": once is for good";
    }
}

// ---- Memory that changes by itself ----

TEST_F(SafetySupervisorTest, TimeOfAContradictionThatAgreesWithItsComplementIsBelieved) {
    verifies("SWR-SAF-023", Technique::kBoundaryValues);
    operate();
    state_.faults = to_bit(ArmFault::kPowerLost);
    for (std::int64_t i = 0; i <= kTorqueFeedbackTime.ns / kFrame.ns; ++i) {
        ASSERT_EQ(step().state, SafeState::kSafe) << i;
    }
    reading_.torque_enabled = false;
    for (int i = 0; i < 100; ++i) {
        ASSERT_EQ(step().state, SafeState::kSafe) << "torque went at last, frame " << i;
    }
}

TEST_F(SafetySupervisorTest, EachFlippedBitOfTheTimeOfAContradictionLocksOut) {
    verifies("SWR-SAF-023", Technique::kFaultInjection, Polarity::kViolation);
    // The time is zero: eight bytes of zeros, and their complement behind them.
    std::array<unsigned char, 16U> forms{};
    std::memset(forms.data() + 8U, 0xFF, 8U);
    operate();
    auto* const image = reinterpret_cast<unsigned char*>(&sut_);  // NOLINT: memory that changes by itself
    std::size_t place = sizeof(sut_);
    std::size_t places = 0U;
    for (std::size_t i = 0U; i + forms.size() <= sizeof(sut_); i += alignof(Duration)) {
        if (std::memcmp(image + i, forms.data(), forms.size()) == 0) {
            place = i;
            ++places;
        }
    }
    ASSERT_EQ(places, 1U);
    std::array<unsigned char, sizeof(SafetySupervisor)> sound{};
    std::memcpy(sound.data(), image, sound.size());

    for (std::size_t bit = 0U; bit < forms.size() * 8U; ++bit) {
        image[place + bit / 8U] = static_cast<unsigned char>(image[place + bit / 8U] ^ (1U << (bit % 8U)));
        const StopCommand command = step();
        EXPECT_EQ(command.state, SafeState::kLockedOut) << "bit " << bit;
        EXPECT_FALSE(command.torque_enable);
        std::memcpy(image, sound.data(), sound.size());
    }
    EXPECT_EQ(step().state, SafeState::kOperational);
}

}  // namespace
}  // namespace safe_arm
