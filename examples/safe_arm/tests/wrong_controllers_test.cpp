// SPDX-License-Identifier: Apache-2.0
// Goal: no controller, however wrong, moves the arm beyond its mechanical limits. Method: a wrong controller
// per number takes over in a random motion near the safe speed; the true motion in each integration step is
// judged. One process per number, since the table is static. MAMORI_CONTROLLERS sets how many are tried.
#include "wrong_controller.hpp"

#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <random>

#include "arm_start.hpp"
#include "machine.hpp"
#include "mamori/simbody_sim/computed_torque_controller.hpp"
#include "mamori/trace/verifies.hpp"
#include "safe_arm_system.hpp"

namespace safe_arm {
namespace {

using mamori::Duration;
using mamori::Instant;
using mamori::safety::SafeState;
using namespace mamori::verification;

#if defined(__SANITIZE_ADDRESS__)
constexpr int kControllersUsual = 12;
#else
constexpr int kControllersUsual = 200;
#endif
constexpr Duration kWatched = 1500_ms;
constexpr Duration kHeld = 200_ms;
constexpr double kDriftMaxRad = 0.002;

struct Outcome {
    bool is_complete{false};
    bool was_operational{false};  ///< when the wrong controller took over
    SafeState state{};
    double speed_share{0.0};  ///< maximum speed, of the mechanical limit of its joint
    double margin_rad{0.0};
    double drift_rad{0.0};
    bool has_stood{false};
};

class Attack final : public mamori::Devices {
  public:
    Attack(Machine& machine, Instant begins, Outcome& outcome) noexcept
        : machine_(machine), begins_(begins), outcome_(outcome) {}

    void sample(std::uint64_t frame, Instant now) noexcept override {
        if (now >= begins_ && !has_begun_) {
            has_begun_ = true;
            outcome_.was_operational = supervisor.get_state() == SafeState::kOperational;
        }
        machine_.sample(frame, now);
    }
    void apply(std::uint64_t frame, Instant now, Duration length) noexcept override {
        machine_.apply(frame, now, length);
        const SafeState state = supervisor.get_state();
        const bool is_at_end = state == SafeState::kSafe || state == SafeState::kLockedHold;
        held_ = is_at_end ? held_ + length : Duration{0};
        const bool is_watched = now >= begins_ + kWatched && state == SafeState::kOperational;
        const bool has_not_started = has_begun_ && !outcome_.was_operational;
        if (held_ >= kHeld || is_watched || has_not_started) {
            outcome_.is_complete = true;
            simulation.request_stop();
        }
    }

  private:
    Machine& machine_;
    Instant begins_;
    Outcome& outcome_;
    Duration held_{};
    bool has_begun_{false};
};

/// Two poses and minimum-jerk motion between them, each joint at up to 90 % of its safe speed.
void write_motion(const std::string& path, std::mt19937_64& random, double& duration_s) {
    std::uniform_real_distribution<double> share{-1.0, 1.0};
    JointVector from_rad{};
    JointVector travel_rad{};
    duration_s = 1.2;
    for (std::size_t j = 0U; j < kArmJointCount; ++j) {
        travel_rad[j] = 0.9 * kSafeSpeedRadS[j] * duration_s * 8.0 / 15.0 * share(random);
        from_rad[j] = (0.9 * kSafePositionRad[j] - std::fabs(travel_rad[j])) * share(random);
    }
    std::ofstream motion{path};
    for (int i = 0; i <= 240; ++i) {
        const double s = i / 240.0;
        const double covered = s * s * s * (10.0 - 15.0 * s + 6.0 * s * s);
        motion << s * duration_s;
        for (std::size_t j = 0U; j < kArmJointCount; ++j) {
            motion << ' ' << from_rad[j] + covered * travel_rad[j];
        }
        motion << '\n';
    }
}

Outcome attack(const mamori::sim::ArmModel& model, int number) {
    std::mt19937_64 random{static_cast<std::uint64_t>(number)};
    const std::string path = ::testing::TempDir() + "wrong_controller_" + std::to_string(::getpid()) + ".txt";
    double duration_s = 0.0;
    write_motion(path, random, duration_s);
    MotionTrack track;
    std::string error;
    const bool is_read = track.read(path, kFrameS, error);
    std::remove(path.c_str());
    Outcome outcome{};
    mamori::sim::ComputedTorqueController law{model};
    if (!is_read || !prepare_system(model, track, law).empty()) {
        return outcome;
    }
    mamori::sim::FaultPlan fault{};
    fault.kind = mamori::sim::FaultKind::kControllerWrong;
    fault.magnitude = number;
    const double at_s = std::uniform_real_distribution<double>{0.0, duration_s + 0.2}(random);
    fault.at = kMotionStart + Duration{std::llround(at_s * 1.0e9)};
    mamori::sim::ArmPlant plant{model};
    plant.reset(track.calc_point(0.0).position_rad);
    RunRecord record{{}, model, fault, Instant{} + kMotionStart, Instant{} + kMotionStart};
    plant.set_observer(&record.get_verdict());
    Machine machine{plant, virtual_host, fault, record};
    Attack devices{machine, Instant{} + fault.at, outcome};
    static_cast<void>(simulate(5000U, devices));
    const mamori::sim::PhysicalVerdict& verdict = record.get_verdict();
    outcome.state = supervisor.get_state();
    for (std::size_t j = 0U; j < kArmJointCount; ++j) {
        outcome.speed_share = std::max(outcome.speed_share,
                                       verdict.get_max_speed_rad_s()[j] / model.joints[j].speed_limit_rad_s);
    }
    outcome.margin_rad = verdict.get_min_position_margin_rad();
    outcome.drift_rad = verdict.get_hold_drift_rad();
    outcome.has_stood = verdict.get_standstill().has_value();
    return outcome;
}

/// Runs attack() in a process of its own. @return read end of a pipe that gets the outcome.
int begin_attack(const mamori::sim::ArmModel& model, int number) {
    std::array<int, 2U> ends{};
    EXPECT_EQ(::pipe(ends.data()), 0);
    const pid_t child = ::fork();
    EXPECT_GE(child, 0);
    if (child == 0) {
        const Outcome outcome = attack(model, number);
        ::_exit(::write(ends[1], &outcome, sizeof(outcome)) == sizeof(outcome) ? 0 : 1);
    }
    ::close(ends[1]);
    return ends[0];
}

/// @return an incomplete one if the process died.
Outcome end_attack(int pipe) {
    Outcome outcome{};
    if (::read(pipe, &outcome, sizeof(outcome)) != sizeof(outcome)) {
        outcome = {};
    }
    ::close(pipe);
    static_cast<void>(::wait(nullptr));
    return outcome;
}

TEST(WrongControllersTest, NoneExceedsAMechanicalLimitAndTheArmIsHeld) {
    verifies("SYS-035", Technique::kFaultInjection, Polarity::kViolation);
    const mamori::sim::LoadedModel loaded = mamori::sim::load_arm_model(SAFE_ARM_MODEL_FILE);
    ASSERT_TRUE(loaded.model.has_value()) << loaded.error;
    const char* const wanted = std::getenv("MAMORI_CONTROLLERS");
    const int count = wanted == nullptr ? kControllersUsual : std::atoi(wanted);
    ASSERT_GT(count, 0) << "MAMORI_CONTROLLERS is not a number above 0";
    const char* const begin_text = std::getenv("MAMORI_CONTROLLERS_FROM");
    const int first = begin_text == nullptr ? 0 : std::atoi(begin_text);
    constexpr int kAtOnce = 2;
    std::array<int, kAtOnce> pipes{};
    int operational_count = 0;
    int stopped_count = 0;
    double speed_share = 0.0;
    for (int begun = 0; begun < count + kAtOnce; ++begun) {
        int& pipe = pipes[static_cast<std::size_t>(begun % kAtOnce)];
        const int number = first + begun - kAtOnce;
        if (begun >= kAtOnce) {
            const Outcome outcome = end_attack(pipe);
            const bool is_held = outcome.state == SafeState::kSafe && outcome.has_stood;
            const bool is_harmless = outcome.state == SafeState::kOperational;
            EXPECT_TRUE(outcome.is_complete) << number;
            EXPECT_TRUE(is_held || is_harmless || !outcome.was_operational)
                << number << ": " << get_name(outcome.state);
            EXPECT_LE(outcome.speed_share, 1.0) << number;
            EXPECT_GE(outcome.margin_rad, 0.0) << number;
            EXPECT_LE(outcome.drift_rad, kDriftMaxRad) << number;
            operational_count += outcome.was_operational ? 1 : 0;
            stopped_count += outcome.was_operational && is_held ? 1 : 0;
            speed_share = std::max(speed_share, outcome.speed_share);
        }
        if (begun < count) {
            pipe = begin_attack(*loaded.model, first + begun);
        }
    }
    std::printf("%d controllers, %d took over in operation, %d stopped; maximum speed %.1f %% of its limit\n",
                count, operational_count, stopped_count, 100.0 * speed_share);
    // In the others, the arm still vibrates after its brake test when the start button is pushed.
    EXPECT_GE(operational_count, count * 3 / 4);
    EXPECT_GE(stopped_count, count / 3) << "most kinds are harmful";
}

TEST(WrongControllersTest, ANumberGivesTheSameController) {
    verifies("SWR-SAF-044");
    for (std::uint64_t number = 0U; number < 24U; ++number) {
        WrongController a{number};
        WrongController b{number};
        EXPECT_EQ(static_cast<std::uint64_t>(a.get_kind()),
                  number % static_cast<std::uint64_t>(Wrong::kCount));
        for (int frame = 0; frame < 100; ++frame) {
            TorqueCommand of_a{};
            of_a.torque_nm.fill(1.0 + frame);
            TorqueCommand of_b = of_a;
            JointState state{};
            state.velocity_rad_s.fill(0.1);
            a.corrupt(of_a, state);
            b.corrupt(of_b, state);
            ASSERT_EQ(of_a.torque_nm, of_b.torque_nm) << number;
            ASSERT_EQ(of_a.setpoint_rad, of_b.setpoint_rad) << number;
        }
    }
}

TEST(WrongControllersTest, EachKindChangesTheTorqueOfAJoint) {
    verifies("SWR-SAF-044", Technique::kEquivalenceClasses);
    for (std::uint64_t number = 0U; number < static_cast<std::uint64_t>(Wrong::kCount); ++number) {
        WrongController sut{number};
        bool is_changed = false;
        for (int frame = 0; frame < 200; ++frame) {
            TorqueCommand command{};
            command.torque_nm.fill(1.0 + 0.01 * frame);
            const JointVector sound_nm = command.torque_nm;
            JointState state{};
            state.velocity_rad_s.fill(0.1);
            sut.corrupt(command, state);
            is_changed = is_changed || command.torque_nm != sound_nm;
        }
        EXPECT_TRUE(is_changed) << number;
    }
}

}  // namespace
}  // namespace safe_arm
