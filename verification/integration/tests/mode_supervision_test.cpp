// SPDX-License-Identifier: Apache-2.0
// Goal: supervision expects a component in the modes that run it, and in no other. Method: a machine with a
// safety cycle and modes in virtual time; the kernel switches the modes.
#include <gtest/gtest.h>

#include "mamori/kernel/run/system_modes.hpp"
#include "mamori/ports/virtual_time/machine.hpp"
#include "mamori/ports/virtual_time/virtual_watchdog.hpp"
#include "mamori/safety/cycle/safety_cycle.hpp"
#include "mamori/trace/verifies.hpp"

namespace mamori::verification::integration {
namespace {

using namespace literals;
using namespace safety;

enum class Fault : FaultIndex { kDriveSilent, kInternal };
enum class Command { kWork, kRest };
enum class Mode { kIdle, kWork, kHalt };

extern SafetyState g_safety;
SystemModes& get_modes();

class Worker final : public Component {
  public:
    constexpr explicit Worker(const char* name) noexcept : Component(name) {}
};

/// Does nothing but decide: the machine stands, and its self test passes.
class Decider final : public SafetyCycle {
  public:
    constexpr Decider() noexcept : SafetyCycle("decider", g_safety, nullptr) {}
    using SafetyCycle::is_watchdog_serviced;

  private:
    CycleInputs read_inputs(Instant) noexcept override {
        CycleInputs inputs{};
        inputs.is_standing = true;
        inputs.are_brakes_closed = true;
        inputs.has_torque = false;
        inputs.mode = static_cast<std::size_t>(get_modes().get_mode());
        return inputs;
    }
    SelfTestStatus step_self_test(bool, Instant) noexcept override { return SelfTestStatus::kRunning; }
    bool is_present(FaultIndex) noexcept override { return false; }
    void command(SafeState, const StopOutputs&) noexcept override {}
};

Worker g_drive{"drive"};
Worker g_reader{"reader"};
Decider g_decider;
ports::virtual_time::VirtualWatchdog g_watchdog{5_ms};

constexpr auto kSystem = safety::system(
    frame(1_ms), window("drive", 0_us, 200_us, budget(100_us), run(g_drive)),
    window("decide", 300_us, 500_us, budget(400_us), run(g_reader, g_decider)),
    system_mode<Mode::kIdle>("idle", runs(g_reader, g_decider)),
    system_mode<Mode::kWork>("work", runs(g_drive, g_reader, g_decider)),
    safe_mode<Mode::kHalt>("halt", runs(g_reader, g_decider)),
    mode_transition("idle", Command::kWork, "work"), mode_transition("work", Command::kRest, "idle"),
    faults<Fault::kDriveSilent, Fault::kInternal>(),
    react(Fault::kDriveSilent, Reaction::kDegrade, within(2_ms)),
    react(Fault::kInternal, Reaction::kDegrade, within(2_ms)),
    supervise(g_reader, alive(1U, 2U), deadline(100_us)),
    supervise(g_decider, alive(1U, 2U), deadline(100_us)),
    supervise(g_drive, alive(1U, 2U), deadline(100_us), raises(Fault::kDriveSilent)),
    cycle(StopBounds{20_ms, 20_ms}, BrakeLimits{10_ms, true}, WatchdogWindow{500_us, 4_ms},
          torque_feedback(5_ms), tolerated_lateness(50_us), on_late_reaction(raises(Fault::kInternal)),
          on_failed_self_test(raises(Fault::kInternal)), on_unconfirmed_brakes(raises(Fault::kInternal))));
MAMORI_SAFETY_CHECK(kSystem);
SafetyStorage<kSystem> g_storage;
SafetyState g_safety{g_storage, g_watchdog};
ports::virtual_time::Machine<kSystem> g_machine;

SystemModes& get_modes() {
    return g_machine.get_executives().get_modes();
}

/// Requests switches, and lets the drive hang from a frame on.
class Course final : public Devices {
  public:
    void sample(std::uint64_t frame, Instant) noexcept override {
        begin_ = begin_ == kNever ? frame : begin_;
        const std::uint64_t number = frame - begin_;
        if (number == 20U) {
            EXPECT_EQ(get_modes().request(Command::kWork), Status::kOk);
        }
        if (number == 60U) {
            EXPECT_EQ(get_modes().request(Command::kRest), Status::kOk);
        }
        if (number == safe_at) {
            EXPECT_EQ(get_modes().request_safe_mode(), Status::kOk);
        }
        if (number == hang_at) {
            static_cast<void>(g_machine.get_host_of<0U>().set_duration(g_drive, ports::virtual_time::kNever));
        }
    }
    void apply(std::uint64_t frame, Instant now, Duration length) noexcept override {
        g_watchdog.check(now + length);
        mode_frames[static_cast<std::size_t>(get_modes().get_mode())] += 1U;
        if (first_fault_at == 0U && g_safety.get_faults().is_latched(FaultIndex{0U})) {
            first_fault_at = frame - begin_;
        }
    }
    static constexpr std::uint64_t kNever = ~std::uint64_t{0U};
    std::uint64_t safe_at{kNever};
    std::uint64_t hang_at{kNever};
    std::uint64_t first_fault_at{0U};
    std::array<std::uint64_t, 3U> mode_frames{};

  private:
    std::uint64_t begin_{kNever};  ///< frames are numbered over all runs
};

class ModeSupervisionTest : public ::testing::Test {
  protected:
    void SetUp() override { g_machine.get_executives().get(0U).set_observer(&g_safety.get_observer()); }
};

TEST_F(ModeSupervisionTest, AComponentIsSilentInTheModesThatDoNotRunIt) {
    verifies("SWR-CYC-031", Technique::kStateTransition);
    Course course;
    course.safe_at = 100U;
    ASSERT_EQ(g_machine.run(150U, course), Status::kOk);

    EXPECT_EQ(course.first_fault_at, 0U);
    EXPECT_FALSE(g_watchdog.has_expired());
    EXPECT_EQ(g_safety.get_supervision().get_first_expired(), ExecutionSupervisor::kNoComponent);
    for (const std::uint64_t frames : course.mode_frames) {
        EXPECT_GT(frames, 20U);
    }
    ASSERT_EQ(get_modes().reset(), Status::kOk);
}

TEST_F(ModeSupervisionTest, AComponentThatHangsInItsModeIsFound) {
    verifies("SWR-CYC-031", Technique::kFaultInjection, Polarity::kViolation);
    Course course;
    course.hang_at = 45U;
    EXPECT_EQ(g_machine.run(55U, course), Status::kError) << "the hang";

    EXPECT_GE(course.first_fault_at, 45U);
    EXPECT_LE(course.first_fault_at, 47U);
}

}  // namespace
}  // namespace mamori::verification::integration
