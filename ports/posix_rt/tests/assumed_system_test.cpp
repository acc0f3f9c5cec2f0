// SPDX-License-Identifier: Apache-2.0
// Goal: a component of a real-time system checks from inside a window that all assumptions of use hold, and
// names a violated one. Method: a real executive whose only component queries all platform properties of this
// port in each major frame, with locked memory and fixed priorities. Then the thread of the component changes
// its rounding mode, the runner loses its priority, memory is unlocked, or the watchdog is closed.
#include <gtest/gtest.h>
#include <sys/mman.h>

#include <array>
#include <cfenv>
#include <functional>
#include <string>
#include <utility>

#include "mamori/kernel/run/executive.hpp"
#include "mamori/kernel/system/system.hpp"
#include "mamori/ports/posix_rt/clock_sources.hpp"
#include "mamori/ports/posix_rt/core_runner.hpp"
#include "mamori/ports/posix_rt/guarded_host.hpp"
#include "mamori/ports/posix_rt/provisions.hpp"
#include "mamori/safety/assumptions/assumption_monitor.hpp"
#include "mamori/trace/verifies.hpp"

namespace mamori::ports::posix_rt {
namespace {

using safety::assume;
using safety::ProvisionCheck;
using safety::SelfTestStatus;
using namespace verification;

constexpr Duration kFrame = 5_ms;
constexpr std::int64_t kChange = 60;  ///< major frame in which a property is removed
constexpr std::uint64_t kFrames = 70U;
constexpr Duration kHour{3'600'000'000'000};

void keep_outputs(void*) noexcept {}

enum class Assumption : safety::AssumptionIndex { kTick, kTimers, kMemory, kFpu, kGuard, kWatchdog, kCount };

/// Objects that the checks of one run need. Static storage, as the table requires.
struct Platform {
    FrameClock clock = FrameClock::starting_in(50_ms);
    ReadingSource reference{get_raw_clock()};
    TickSource tick{clock};
    // Much more than the delay of a thread with fixed priority between two readings.
    safety::TickSourceCheck tick_check{reference, tick, {100_ms, 200000U}};
    PreciseTimers timers{};
    ProvisionCheck timers_check{timers};
    MemoryLocked memory{};
    ProvisionCheck memory_check{memory};
    FloatingPointMode fpu{};
    ProvisionCheck fpu_check{fpu};
    GuardAbove guard{};
    ProvisionCheck guard_check{guard};
    SoftwareWatchdog watchdog{clock, {0_ms, kHour}, {&keep_outputs, nullptr, false}};
    SoftwareWatchdogArmed armed{watchdog};
    ProvisionCheck watchdog_check{armed};
};

/// Services the watchdog and checks the assumptions, as a supervisor does.
class Asker final : public Component {
  public:
    Asker() noexcept : Component("asker") {}
    using Ports = mamori::Ports<>;

    Platform* platform{nullptr};
    safety::AssumptionMonitor* assumptions{nullptr};
    std::function<void()> change{};
    SelfTestStatus status_before_change{SelfTestStatus::kRunning};

    Status on_execute(ContextHandle handle) noexcept override {
        ++cycles_;
        if (cycles_ == kChange) {
            status_before_change = assumptions->get_status();
            if (change) {
                change();
            }
        }
        static_cast<void>(platform->watchdog.service(handle.now));
        static_cast<void>(assumptions->step(handle.now));
        return Status::kOk;
    }

  private:
    std::int64_t cycles_{0};
};

class AssumedSystemTest : public ::testing::Test {
  protected:
    /// Runs the system and executes `change` during the run. @return false without the privileges.
    bool run(std::function<void()> change) {
        asker_.platform = &platform_;
        asker_.assumptions = &monitor_;
        asker_.change = std::move(change);
        const bool has_rights =
            lock_memory(65536U).is_granted && set_priority(pthread_self(), 20).is_granted &&
            platform_.memory.open() == Status::kOk && host_.open() == Status::kOk &&
            host_.get_priority_right().is_granted && platform_.memory.look() == Status::kOk;
        if (has_rights) {
            EXPECT_EQ(platform_.watchdog.open({30, ThreadPlace::kAnyProcessor}), Status::kOk);
            EXPECT_EQ(executive_.initialize(), Status::kOk);
            EXPECT_EQ(executive_.start(), Status::kOk);
            platform_.guard.set_guard();
            CoreRunner runner{executive_, host_, platform_.clock};
            runner.run(kFrames);
            EXPECT_EQ(asker_.status_before_change, SelfTestStatus::kPassed) << monitor_.get_failed_name();
            static_cast<void>(platform_.watchdog.close());
        }
        static_cast<void>(host_.close());
        EXPECT_TRUE(set_priority(pthread_self(), 0).is_granted);
        EXPECT_EQ(munlockall(), 0);
        return has_rights;
    }
    std::string get_failed() const { return monitor_.get_failed_name(); }

    const pthread_t runner_ = pthread_self();
    Platform platform_;
    const std::array<safety::AssumptionRow, 6U> rows_{
        assume(Assumption::kTick, "tick", platform_.tick_check, 400_ms),
        assume(Assumption::kTimers, "timers", platform_.timers_check, 100_ms),
        assume(Assumption::kMemory, "memory", platform_.memory_check, 100_ms),
        assume(Assumption::kFpu, "floating point", platform_.fpu_check, 100_ms),
        assume(Assumption::kGuard, "guard", platform_.guard_check, 100_ms),
        assume(Assumption::kWatchdog, "watchdog", platform_.watchdog_check, 100_ms)};
    safety::AssumptionMonitor monitor_{rows_};
    Asker asker_;
    SystemTable<1U, 1U, 0U, 0U> table_ =
        system(frame(kFrame), window("only", 0_ms, 4_ms, budget(4_ms), mamori::run(asker_)));
    std::array<WindowThread, 1U> threads_;
    GuardedHost host_{threads_, platform_.clock, {10, ThreadPlace::kAnyProcessor}};
    ExecutiveFor<decltype(table_)> executive_{table_};
};

constexpr const char* kNoRights = "verdict=no-privilege: no privilege for fixed priorities or locked memory";

TEST_F(AssumedSystemTest, WindowFindsAllPropertiesInEffect) {
    verifies("SWR-AOU-014", Technique::kInterface);
    if (!run({})) {
        GTEST_SKIP() << kNoRights;
    }
    EXPECT_EQ(monitor_.get_status(), SelfTestStatus::kPassed) << get_failed();
}

TEST_F(AssumedSystemTest, RunnerThatLosesItsPriorityIsNamed) {
    verifies("SWR-AOU-014", Technique::kFaultInjection, Polarity::kViolation);
    if (!run([this] { static_cast<void>(set_priority(runner_, 0)); })) {
        GTEST_SKIP() << kNoRights;
    }
    EXPECT_EQ(get_failed(), "guard");
}

TEST_F(AssumedSystemTest, OtherRoundingOnTheThreadOfTheWindowIsNamed) {
    verifies("SWR-AOU-013", Technique::kFaultInjection, Polarity::kViolation);
    if (!run([] { static_cast<void>(std::fesetround(FE_TOWARDZERO)); })) {
        GTEST_SKIP() << kNoRights;
    }
    EXPECT_EQ(get_failed(), "floating point");
}

TEST_F(AssumedSystemTest, UnlockedMemoryIsNamed) {
    verifies("SWR-AOU-011", Technique::kFaultInjection, Polarity::kViolation);
    if (!run([] { static_cast<void>(munlockall()); })) {
        GTEST_SKIP() << kNoRights;
    }
    EXPECT_EQ(get_failed(), "memory");
}

TEST_F(AssumedSystemTest, ClosedWatchdogIsNamed) {
    verifies("SWR-AOU-015", Technique::kFaultInjection, Polarity::kViolation);
    if (!run([this] { static_cast<void>(platform_.watchdog.close()); })) {
        GTEST_SKIP() << kNoRights;
    }
    EXPECT_EQ(get_failed(), "watchdog");
}

}  // namespace
}  // namespace mamori::ports::posix_rt
