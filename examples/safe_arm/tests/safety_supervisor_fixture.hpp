// SPDX-License-Identifier: Apache-2.0
/// @file
/// The supervisor of the arm with a watchdog and an assumption that answer as the test says, frame by frame.
#ifndef SAFE_ARM_TESTS_SAFETY_SUPERVISOR_FIXTURE_HPP
#define SAFE_ARM_TESTS_SAFETY_SUPERVISOR_FIXTURE_HPP

#include <gtest/gtest.h>

#include <array>
#include <cstddef>

#include "arm_safety.hpp"
#include "feed.hpp"
#include "safety_supervisor.hpp"

namespace safe_arm {
// Unnamed: the table below needs checks whose addresses are constants, and with the sanitizers GCC does not
// take that of an inline variable for one.
namespace {

/// An assumption of use whose check answers as the test says.
class FakeCheck final : public mamori::safety::AssumptionCheck {
  public:
    mamori::safety::SelfTestStatus check() noexcept override { return answer; }
    mamori::safety::SelfTestStatus answer{mamori::safety::SelfTestStatus::kPassed};
};
FakeCheck g_sound;
FakeCheck g_check;
enum class Assumption : mamori::safety::AssumptionIndex { kSound, kChecked };

class Supervised final : public mamori::Component {
  public:
    constexpr explicit Supervised(const char* name) noexcept : Component(name) {}
};
/// In the table instead of the supervisor, which the test calls itself.
class InsteadOfCycle final : public mamori::Component, public mamori::safety::CycleComponent {
  public:
    constexpr explicit InsteadOfCycle(const char* name) noexcept : Component(name) {}
    mamori::InPort<JointState> state{*this, "state"};
    using Ports = mamori::Ports<&InsteadOfCycle::state>;
};
/// In the table instead of reader and monitor.
class Measuring final : public mamori::Component {
  public:
    constexpr explicit Measuring(const char* name) noexcept : Component(name) {}
    mamori::OutPort<JointState> state{*this, "state"};
    using Ports = mamori::Ports<&Measuring::state>;
};
Measuring g_measuring{"measuring"};
InsteadOfCycle g_other{"other"};
Supervised g_controller{"controller"};
constexpr auto kSupervised = mamori::safety::system(
    mamori::frame(kFrame), make_arm_safety(kLatenessMax), make_arm_modes(g_measuring, g_other, g_controller),
    mamori::safety::assume(Assumption::kSound, "sound", g_sound, kSelfTestTime),
    mamori::safety::assume(Assumption::kChecked, "checked", g_check, kSelfTestTime),
    mamori::safety::supervise(g_other, mamori::safety::alive(),
                              mamori::safety::deadline(kSafetyComponentMax)),
    mamori::safety::supervise(g_controller, mamori::safety::alive(),
                              mamori::safety::deadline(kSafetyComponentMax),
                              mamori::safety::raises(ArmFault::kControllerSilent)),
    mamori::safety::supervise(g_measuring, mamori::safety::alive(),
                              mamori::safety::deadline(kSafetyComponentMax)),
    mamori::safety::confirmed_by(g_measuring.state, mamori::safety::StopConfirmation::kStandstill,
                                 mamori::safety::StopConfirmation::kClosedBrakes,
                                 mamori::safety::StopConfirmation::kTorqueOff),
    mamori::connect(g_measuring.state, g_other.state, mamori::any_age()),
    mamori::window("all", 0_us, kFrame, mamori::budget(kFrame),
                   mamori::run(g_measuring, g_other, g_controller)));
constexpr std::size_t kOther = mamori::index_of(kSupervised, g_other);
constexpr std::size_t kController = mamori::index_of(kSupervised, g_controller);
constexpr std::size_t kMeasuring = mamori::index_of(kSupervised, g_measuring);

class SpyWatchdog final : public mamori::safety::Watchdog {
  public:
    mamori::Status service(mamori::Instant) noexcept override {
        services += answer == mamori::Status::kOk ? 1 : 0;
        return answer;
    }
    int services{0};
    mamori::Status answer{mamori::Status::kOk};
};

class SafetySupervisorFixture : public ::testing::Test {
  protected:
    void SetUp() override {
        g_check.answer = mamori::safety::SelfTestStatus::kPassed;
        ASSERT_EQ(sut_.initialize(), mamori::Status::kOk);
        reading_.mode = OperatingMode::kAutomatic;
        reading_.power_good = true;
        reading_.brakes_closed = true;
        state_.is_standing = true;
        state_.is_setpoint_near = true;
        state_.is_clock_checked = true;
    }

    /// One frame: the components run as `is_other_running_` and `is_controller_running_` say, then the
    /// supervisor decides.
    StopCommand step() {
        supervision_.get_records()[kMeasuring].note_run(now_, now_ + 10_us);
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
        EXPECT_EQ(sut_.on_execute({0, now_}), mamori::Status::kOk);
        // The gate applies the command of this frame; the next cycle reads it.
        const StopCommand given = take(sut_.stop);
        if (is_gate_running_) {
            feed(sut_.drive, DriveCommand{{},
                                          given.torque_enable,
                                          given.brake_release,
                                          given.relay_close,
                                          given.torque_source,
                                          {}});
        }
        if (given.state == mamori::safety::SafeState::kSelfTest) {
            follow_start_up(given);
        }
        sut_.reading.mark_read();
        sut_.arm_state.mark_read();
        now_ = now_ + kFrame;
        return given;
    }
    /// Sound devices in the self test.
    void follow_start_up(const StopCommand& given) {
        reading_.relay_closed = given.relay_close;
        reading_.torque_enabled = given.torque_enable && given.relay_close;
    }
    StopCommand step_until(mamori::safety::SafeState wanted, int frames_max) {
        StopCommand command{};
        for (int i = 0; i < frames_max && sut_.get_state() != wanted; ++i) {
            command = step();
        }
        return command;
    }
    StopCommand operate() {
        step_until(mamori::safety::SafeState::kStandby, 400);
        reading_.start_button = true;
        StopCommand command = step();
        reading_.start_button = false;
        reading_.brakes_closed = false;
        reading_.torque_enabled = true;
        return command;
    }

    mamori::safety::SafetyStorage<kSupervised> storage_;
    std::array<mamori::Event, 32U> events_{};
    mamori::EventLog log_{events_};
    SpyWatchdog watchdog_;
    mamori::safety::SafetyState safety_{storage_, watchdog_};
    mamori::safety::ExecutionSupervisor& supervision_ = safety_.get_observer();
    SafetySupervisor sut_{safety_, log_};
    JointReading reading_{};
    JointState state_{};
    mamori::Instant now_{};
    bool is_reader_running_{true};
    bool is_monitor_running_{true};
    bool is_other_running_{true};
    bool is_controller_running_{true};
    bool is_gate_running_{true};
};

}  // namespace
}  // namespace safe_arm

#endif  // SAFE_ARM_TESTS_SAFETY_SUPERVISOR_FIXTURE_HPP
