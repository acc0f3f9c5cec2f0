// SPDX-License-Identifier: Apache-2.0
/// @file
/// A machine with a safety cycle for tests: a table with one fault of each kind, and outputs that follow the
/// commands or ignore them.
#ifndef MAMORI_SAFETY_TESTS_SAFETY_CYCLE_FIXTURE_HPP
#define MAMORI_SAFETY_TESTS_SAFETY_CYCLE_FIXTURE_HPP

#include "mamori/safety/cycle/safety_cycle.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <functional>
#include <string>
#include <vector>

#include "mamori/trace/verifies.hpp"

namespace mamori::safety::testing_of_cycle {

using namespace literals;
using namespace verification;

enum class Fault : FaultIndex { kFast, kSlip, kSilent, kLate, kSelfTest, kBrake, kWarm, kLost };
inline constexpr std::size_t kFaultCount = 8U;
inline constexpr Duration kFrame = 1_ms;
inline constexpr Duration kTorqueFeedback = 5_ms;

class Watched final : public Component {
  public:
    constexpr explicit Watched(const char* name) noexcept : Component(name) {}
};

class FakeMachine final : public SafetyCycle {
  public:
    FakeMachine(SafetyState& state, EventLog* log) noexcept : SafetyCycle("machine", state, log) {}

    CycleInputs inputs{};
    std::array<bool, kFaultCount> present{};
    SelfTestStatus self_test{SelfTestStatus::kPassed};
    bool is_testing_torque{false};
    SafeState commanded{SafeState::kLockedOut};
    StopOutputs outputs{};
    std::vector<std::string> calls{};
    std::function<void()> after_command{};

    using SafetyCycle::has_reaction;
    using SafetyCycle::is_watchdog_serviced;

  private:
    CycleInputs read_inputs(Instant) noexcept override {
        calls.emplace_back("inputs");
        return inputs;
    }
    SelfTestStatus step_self_test(bool is_first, Instant) noexcept override {
        calls.emplace_back(is_first ? "first self test" : "self test");
        // A pass counts after a running test.
        return is_first && self_test == SelfTestStatus::kPassed ? SelfTestStatus::kRunning : self_test;
    }
    bool wants_test_torque() noexcept override {
        return is_testing_torque || SafetyCycle::wants_test_torque();
    }
    bool is_present(FaultIndex fault) noexcept override {
        calls.emplace_back("fault " + std::to_string(fault));
        return present[fault];
    }
    void command(SafeState state, const StopOutputs& wanted) noexcept override {
        calls.emplace_back("command");
        commanded = state;
        outputs = wanted;
        if (after_command) {
            after_command();
        }
    }
};

class Sensor final : public Component {
  public:
    constexpr explicit Sensor(const char* name) noexcept : Component(name) {}
    OutPort<std::uint32_t> seen{*this, "seen"};
    using Ports = mamori::Ports<&Sensor::seen>;
};
class Decider final : public Component, public CycleComponent {
  public:
    constexpr explicit Decider(const char* name) noexcept : Component(name) {}
    InPort<std::uint32_t> seen{*this, "seen"};
    using Ports = mamori::Ports<&Decider::seen>;
};
class FakeCheck final : public AssumptionCheck {
  public:
    SelfTestStatus check() noexcept override {
        ++calls;
        return answer;
    }
    SelfTestStatus answer{SelfTestStatus::kPassed};
    int calls{0};
};
inline FakeCheck g_check;
enum class Assumption : AssumptionIndex { kOnly };
inline Decider g_guard{"guard"};
inline Watched g_controller{"controller"};
inline Watched g_logger{"logger"};
inline Sensor g_sensor{"sensor"};
inline constexpr auto kSystem = safety::system(
    frame(kFrame), window("all", 100_us, 900_us, budget(900_us), run(g_guard, g_controller, g_logger)),
    window("sense", 0_us, 100_us, budget(100_us), run(g_sensor)),
    connect(g_sensor.seen, g_guard.seen, any_age()),
    faults<Fault::kFast, Fault::kSlip, Fault::kSilent, Fault::kLate, Fault::kSelfTest, Fault::kBrake,
           Fault::kWarm, Fault::kLost>(),
    react(Fault::kFast, Reaction::kSto, within(2_ms)), react(Fault::kSlip, Reaction::kSs1, within(3_ms)),
    react(Fault::kSilent, Reaction::kSs2, within(2_ms)), react(Fault::kLate, Reaction::kSto, within(1_ms)),
    react(Fault::kSelfTest, Reaction::kSto, within(2_ms)), react(Fault::kBrake, Reaction::kSs1, within(2_ms)),
    react(Fault::kLost, Reaction::kSto, within(2_ms)), react(Fault::kWarm, Reaction::kDegrade, within(2_ms)),
    assume(Assumption::kOnly, "only", g_check, 1_s), confirm(Fault::kSlip, {3U}, {5U}),
    confirm(Fault::kWarm, {1U}, {9U}), supervise(g_guard, alive(2U, 3U), deadline(100_us)),
    supervise(g_controller, alive(2U, 3U), deadline(100_us), raises(Fault::kSilent)),
    supervise(g_logger, alive(2U, 3U), deadline(100_us), raises(Fault::kWarm)),
    supervise(g_sensor, alive(2U, 3U), deadline(100_us)),
    confirmed_by(g_sensor.seen, StopConfirmation::kStandstill, StopConfirmation::kClosedBrakes,
                 StopConfirmation::kTorqueOff),
    cycle(StopBounds{20_ms, 20_ms}, BrakeLimits{10_ms, true}, WatchdogWindow{500_us, 4_ms},
          torque_feedback(kTorqueFeedback), tolerated_lateness(50_us), on_late_reaction(raises(Fault::kLate)),
          on_failed_self_test(raises(Fault::kSelfTest)), on_unconfirmed_brakes(raises(Fault::kBrake)),
          brakes_first<Fault::kLost>()));
MAMORI_SAFETY_CHECK(kSystem);

class SpyWatchdog final : public Watchdog {
  public:
    Status service(Instant) noexcept override {
        ++services;
        return Status::kOk;
    }
    int services{0};
};

class SafetyCycleTest : public ::testing::Test {
  protected:
    void SetUp() override {
        g_check.answer = SelfTestStatus::kPassed;
        ASSERT_EQ(sut_.initialize(), Status::kOk);
        sut_.inputs.is_standing = true;
        sut_.inputs.are_brakes_closed = true;
        sut_.inputs.may_start = true;
    }

    /// One frame. The outputs follow the commands in the next frame unless `is_obeying_` is false.
    SafeState step() {
        sut_.calls.clear();
        if (is_guard_running_) {
            state_.get_observer().get_records()[0U].note_run(now_, now_ + 10_us);
        }
        state_.get_observer().get_records()[2U].note_run(now_, now_ + 10_us);
        if (is_sensor_running_) {
            state_.get_observer().get_records()[3U].note_run(now_, now_ + 10_us);
        }
        if (is_controller_running_) {
            state_.get_observer().get_records()[1U].note_run(now_, now_ + 10_us);
        }
        EXPECT_EQ(sut_.on_execute({0, now_}), Status::kOk);
        if (is_obeying_) {
            sut_.inputs.applied = sut_.outputs;
            sut_.inputs.has_torque = sut_.outputs.torque_enable;
            sut_.inputs.are_brakes_closed = !sut_.outputs.brake_release && !is_contact_silent_;
        }
        now_ = now_ + kFrame;
        return sut_.get_state();
    }
    void operate() {
        for (int i = 0; i < 5 && sut_.get_state() != SafeState::kStandby; ++i) {
            step();
        }
        sut_.inputs.start_button = true;
        ASSERT_EQ(step(), SafeState::kOperational);
        sut_.inputs.start_button = false;
        ASSERT_EQ(step(), SafeState::kOperational);
        sut_.inputs.is_standing = false;
    }
    /// The outputs do not follow any longer; SS1 is demanded in the last of these frames.
    void latch_slip_that_is_not_obeyed() {
        operate();
        is_obeying_ = false;
        set_present(Fault::kSlip, true);
        for (int i = 0; i < 3; ++i) {
            step();
        }
    }
    void set_present(Fault fault, bool is_present) {
        sut_.present[static_cast<std::size_t>(fault)] = is_present;
    }
    bool is_latched(Fault fault) const {
        return state_.get_faults().is_latched(static_cast<FaultIndex>(fault));
    }

    /// @return the only place of these bytes in the state; nullptr: none, or several.
    template <std::size_t kSize>
    unsigned char* find_once(const std::array<unsigned char, kSize>& forms) {
        auto* const image =
            reinterpret_cast<unsigned char*>(&state_);  // NOLINT: memory that changes by itself
        unsigned char* place = nullptr;
        std::size_t count = 0U;
        for (std::size_t i = 0U; i + kSize <= sizeof(state_); ++i) {
            if (std::memcmp(image + i, forms.data(), kSize) == 0) {
                place = image + i;
                ++count;
            }
        }
        return count == 1U ? place : nullptr;
    }

    SafetyStorage<kSystem> storage_;
    SpyWatchdog watchdog_;
    SafetyState state_{storage_, watchdog_};
    std::array<Event, 32U> events_{};
    EventLog log_{events_};
    FakeMachine sut_{state_, &log_};
    Instant now_{};
    bool is_guard_running_{true};
    bool is_controller_running_{true};
    bool is_sensor_running_{true};
    bool is_obeying_{true};
    bool is_contact_silent_{false};  ///< of the brakes
};

}  // namespace mamori::safety::testing_of_cycle

#endif  // MAMORI_SAFETY_TESTS_SAFETY_CYCLE_FIXTURE_HPP
