// SPDX-License-Identifier: Apache-2.0
// Goal: the supervisor trusts neither its assumptions of use, nor the order of its own steps, nor its memory.
// Method: an assumption that answers as the test says, steps from nowhere, each bit of a stored time flipped.
#include <array>
#include <cstddef>
#include <cstring>

#include "mamori/trace/verifies.hpp"
#include "safety_supervisor_fixture.hpp"

namespace safe_arm {
namespace {

using mamori::Duration;
using mamori::Status;
using mamori::safety::SafeState;
using mamori::safety::SelfTestStatus;
using namespace mamori::verification;

using SupervisorIntegrityTest = SafetySupervisorFixture;

// ---- Assumptions of use ----

TEST_F(SupervisorIntegrityTest, SelfTestPassesOnceTheAssumptionsHold) {
    verifies("SWR-SAF-021", Technique::kStateTransition);
    g_check.answer = SelfTestStatus::kRunning;
    for (std::uint32_t i = 0U; i < 250U; ++i) {
        ASSERT_EQ(step().state, SafeState::kSelfTest) << "not known yet, frame " << i;
    }

    g_check.answer = SelfTestStatus::kPassed;
    EXPECT_EQ(step().state, SafeState::kStandby);
    EXPECT_EQ(log_.size(), 1U) << "no event but the state";
}

TEST_F(SupervisorIntegrityTest, AssumptionThatIsNeverKnownToHoldLocksOut) {
    verifies("SWR-SAF-021", Technique::kBoundaryValues, Polarity::kViolation);
    g_check.answer = SelfTestStatus::kRunning;

    step_until(SafeState::kLockedOut, 600);
    EXPECT_EQ(sut_.get_state(), SafeState::kLockedOut);
}

TEST_F(SupervisorIntegrityTest, AssumptionThatIsLostWhileTheArmMovesTakesTorqueAndIsNamedOnce) {
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
        if (log_.get(i).code == static_cast<std::uint16_t>(mamori::safety::CycleEvent::kAssumptionFailed)) {
            EXPECT_EQ(log_.get(i).argument, static_cast<std::int64_t>(Assumption::kChecked));
            ++named;
        }
    }
    EXPECT_EQ(named, 1U);
}

// ---- Order of its own steps ----

TEST_F(SupervisorIntegrityTest, WatchdogIsServedWhileEachFrameBeginsJudgesAndCommands) {
    verifies("SWR-SAF-022");
    for (int i = 1; i <= 100; ++i) {
        step();
        ASSERT_EQ(watchdog_.services, i);
    }
    EXPECT_EQ(safety_.get_flow().supervisor.get_status(), mamori::safety::SupervisionStatus::kOk);
}

TEST_F(SupervisorIntegrityTest, WatchdogIsNotServedOnceAStepCameOutOfItsOrder) {
    verifies("SWR-SAF-022", Technique::kFaultInjection, Polarity::kViolation);
    for (const mamori::safety::FlowPoint point :
         {mamori::safety::FlowPoint::kBegun, mamori::safety::FlowPoint::kJudged,
          mamori::safety::FlowPoint::kCommanded}) {
        SpyWatchdog watchdog;
        mamori::safety::SafetyStorage<kSupervised> storage;
        mamori::safety::SafetyState safety{storage, watchdog};
        SafetySupervisor sut{safety, log_};
        ASSERT_EQ(sut.initialize(), Status::kOk);
        ASSERT_EQ(sut.on_execute({0, now_}), Status::kOk);
        ASSERT_EQ(watchdog.services, 1) << static_cast<int>(point);

        safety.get_flow().report(point, now_ + 1_us);  // control flow that came to a step from nowhere
        for (int i = 0; i < 3; ++i) {
            now_ = now_ + kFrame;
            safety.get_observer().get_records()[kMeasuring].note_run(now_, now_ + 10_us);
            safety.get_observer().get_records()[kOther].note_run(now_, now_ + 10_us);
            safety.get_observer().get_records()[kController].note_run(now_, now_ + 10_us);
            ASSERT_EQ(sut.on_execute({0, now_}), Status::kOk);
        }
        EXPECT_EQ(watchdog.services, 1) << static_cast<int>(point) << ": once is for good";
    }
}

// ---- Memory that changes by itself ----

TEST_F(SupervisorIntegrityTest, TimeOfAContradictionThatAgreesWithItsComplementIsBelieved) {
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

TEST_F(SupervisorIntegrityTest, EachFlippedBitOfTheTimeOfAContradictionLocksOut) {
    verifies("SWR-SAF-023", Technique::kFaultInjection, Polarity::kViolation);
    // The time is zero: eight bytes of zeros, and their complement behind them.
    std::array<unsigned char, 16U> forms{};
    std::memset(forms.data() + 8U, 0xFF, 8U);
    operate();
    auto* const image = reinterpret_cast<unsigned char*>(&safety_);  // NOLINT: memory that changes by itself
    std::size_t place = sizeof(safety_);
    std::size_t places = 0U;
    for (std::size_t i = 0U; i + forms.size() <= sizeof(safety_); i += alignof(Duration)) {
        if (std::memcmp(image + i, forms.data(), forms.size()) == 0) {
            place = i;
            ++places;
        }
    }
    ASSERT_EQ(places, 1U);
    std::array<unsigned char, sizeof(mamori::safety::SafetyState)> sound{};
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
