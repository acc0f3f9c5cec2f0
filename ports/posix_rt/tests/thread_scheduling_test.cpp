// SPDX-License-Identifier: Apache-2.0
// Goal: a hanging window never prevents its guard or another window from running, with any scheduling of the
// thread that opens the host. Method: a runner with a fixed priority and windows that compute without a
// pause, all bound to one processor, so that only policy and priority decide; the tests read policies back
// from Linux. Each hang ends after a few seconds. Without the privilege for fixed priorities the tests that
// need one are skipped.
#include <gtest/gtest.h>
#include <sched.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <functional>
#include <ostream>
#include <thread>

#include "mamori/kernel/run/executive.hpp"
#include "mamori/kernel/system/system.hpp"
#include "mamori/ports/posix_rt/clock_sources.hpp"
#include "mamori/ports/posix_rt/grid_watch.hpp"
#include "mamori/ports/posix_rt/guarded_host.hpp"
#include "mamori/ports/posix_rt/software_watchdog.hpp"
#include "mamori/trace/verifies.hpp"
#include "support/refused_call.hpp"

namespace mamori::ports::posix_rt {
namespace {

using namespace verification;
using literals::operator""_ms;
using literals::operator""_s;

constexpr int kRunnerPriority = 80;
constexpr int kAny = ThreadPlace::kAnyProcessor;
constexpr const char* kNoPrivilege =
    "verdict=no-privilege: this host grants no fixed priority (CAP_SYS_NICE or ulimit -r)";

bool has_privilege() {
    bool is_granted = false;
    std::thread{[&] { is_granted = set_priority(pthread_self(), 99).is_granted; }}.join();
    return is_granted;
}

/// Runs `act` on a thread with a fixed priority, bound to one processor.
void run_as_runner(int priority, const std::function<void()>& act) {
    std::thread{[&] {
        ASSERT_TRUE(set_processor(pthread_self(), sched_getcpu()).is_granted);
        ASSERT_TRUE(set_priority(pthread_self(), priority).is_granted);
        act();
    }}.join();
}

/// Policy and fixed priority of a thread, read from Linux.
struct Scheduling {
    int policy{-1};
    int priority{-1};

    static Scheduling read(pid_t thread) {
        sched_param parameters{};
        const int policy = sched_getscheduler(thread);
        EXPECT_EQ(sched_getparam(thread, &parameters), 0);
        return {policy, parameters.sched_priority};
    }
    friend bool operator==(Scheduling a, Scheduling b) {
        return a.policy == b.policy && a.priority == b.priority;
    }
    friend std::ostream& operator<<(std::ostream& out, Scheduling scheduling) {
        return out << "policy " << scheduling.policy << " priority " << scheduling.priority;
    }
};

constexpr Scheduling kOrdinary{SCHED_OTHER, 0};

/// Two windows: the first computes until it is released, at most three seconds; the second returns at once.
class HangTest : public ::testing::Test {
  protected:
    static constexpr std::size_t kHanging = 0U;
    static constexpr std::size_t kProtecting = 1U;

    static void run_step(void* self, std::size_t, std::size_t) noexcept {
        auto& test = *static_cast<HangTest*>(self);
        test.window_thread_ = gettid();
        test.seen_ = Scheduling::read(0);
        const Instant last = test.clock_.get_now() + 3_s;
        while (test.is_hanging_ && test.clock_.get_now() < last) {
        }
    }
    std::size_t run_window(GuardedHost& host, std::size_t window, Duration budget) {
        is_hanging_ = window == kHanging;
        return host.run_within({&run_step, this, window, window, 0U, 1U, WindowHost::Pass::kExecute},
                               clock_.get_now() + budget);
    }
    /// Lets the first window hang. @return its scheduling after the abort.
    Scheduling hang(GuardedHost& host) {
        EXPECT_EQ(run_window(host, kHanging, 30_ms), 0U);
        EXPECT_FALSE(host.has_returned(kHanging)) << "the guard ran only after the hang";
        return Scheduling::read(window_thread_);
    }
    void expect_that_the_other_window_runs(GuardedHost& host) {
        const auto run = [](void*, std::size_t, std::size_t) noexcept {};
        const WindowHost::Work work{run, nullptr, kProtecting, 1U, 0U, 1U, WindowHost::Pass::kExecute};
        EXPECT_EQ(host.run_within(work, clock_.get_now() + 1_s), 1U);
        EXPECT_FALSE(host.has_returned(kHanging)) << "the other window ran only after the hang";
    }
    /// Releases the first window.
    void wait_until_back(const GuardedHost& host) {
        is_hanging_ = false;
        while (!host.has_returned(kHanging)) {
            clock_.wait_until(clock_.get_now() + 1_ms);
        }
    }
    void end(GuardedHost& host) {
        is_hanging_ = false;
        while (host.close() != Status::kOk) {
            clock_.wait_until(clock_.get_now() + 1_ms);
        }
    }

    const FrameClock clock_ = FrameClock::starting_in(0_ms);
    std::array<WindowThread, 2U> threads_;
    std::atomic<bool> is_hanging_{false};
    std::atomic<pid_t> window_thread_{0};
    Scheduling seen_{};
};

TEST_F(HangTest, WindowsWithoutAPriorityDoNotInheritThatOfTheOpeningThread) {
    verifies("SWR-PRT-040", Technique::kFaultInjection, Polarity::kViolation);
    if (!has_privilege()) {
        GTEST_SKIP() << kNoPrivilege;
    }
    run_as_runner(kRunnerPriority, [this] {
        GuardedHost host{threads_, clock_, {}};
        ASSERT_EQ(host.open(), Status::kOk);
        static_cast<void>(hang(host));
        EXPECT_EQ(seen_, kOrdinary);
        expect_that_the_other_window_runs(host);
        end(host);
    });
}

TEST_F(HangTest, WindowsBelowTheRunnerHaveThePriorityThatIsReported) {
    verifies("SWR-PRT-040");
    if (!has_privilege()) {
        GTEST_SKIP() << kNoPrivilege;
    }
    run_as_runner(kRunnerPriority, [this] {
        GuardedHost host{threads_, clock_, {kRunnerPriority - 1, kAny}};
        ASSERT_EQ(host.open(), Status::kOk);
        EXPECT_TRUE(host.get_priority_right().is_granted);
        static_cast<void>(hang(host));
        EXPECT_EQ(seen_, (Scheduling{SCHED_FIFO, kRunnerPriority - 1}));
        expect_that_the_other_window_runs(host);
        end(host);
    });
}

TEST_F(HangTest, WindowsAtOrAboveTheRunnerAreRejectedAndNoThreadIsLeft) {
    verifies("SWR-PRT-041", Technique::kBoundaryValues, Polarity::kViolation);
    for (const int priority : {kRunnerPriority, kRunnerPriority + 1, 99}) {
        GuardedHost host{threads_, clock_, {priority, kAny}};
        EXPECT_EQ(host.open(kRunnerPriority), Status::kBadParameter) << priority;
        EXPECT_EQ(host.close(), Status::kOk);
    }
    GuardedHost below{threads_, clock_, {kRunnerPriority - 1, kAny}};
    EXPECT_EQ(below.open(kRunnerPriority), Status::kOk) << "the threads can be used again";
    EXPECT_EQ(below.open(kRunnerPriority), Status::kPreconditionNotMet);
    EXPECT_EQ(below.close(), Status::kOk);
}

TEST_F(HangTest, WindowsAtOrAboveTheRunnerAreRejectedAlsoIfTheirPriorityIsDenied) {
    verifies("SWR-PRT-041", Technique::kFaultInjection, Polarity::kViolation);
    EXPECT_EQ(run_in_process([this] {
                  const rlimit none{0U, 0U};
                  ASSERT_EQ(setrlimit(RLIMIT_RTPRIO, &none), 0);
                  ASSERT_EQ(geteuid() == 0U ? setresuid(65534, 65534, 65534) : 0, 0);
                  GuardedHost host{threads_, clock_, {10, kAny}};
                  EXPECT_EQ(host.open(1), Status::kBadParameter);
                  EXPECT_EQ(host.open(10), Status::kBadParameter);
                  for (const int runner : {11, 0}) {
                      EXPECT_EQ(host.open(runner), Status::kOk) << "the runner may have been denied it, too";
                      EXPECT_FALSE(host.get_priority_right().is_granted);
                      EXPECT_EQ(host.get_priority_right().system_error, EPERM);
                      EXPECT_EQ(run_window(host, kProtecting, 60_s), 1U);
                      EXPECT_EQ(seen_, kOrdinary);
                      EXPECT_EQ(host.close(), Status::kOk);
                  }
              }),
              0);
}

TEST_F(HangTest, PriorityOfTheOpeningThreadIsTheDefault) {
    verifies("SWR-PRT-041", Technique::kFaultInjection, Polarity::kViolation);
    if (!has_privilege()) {
        GTEST_SKIP() << kNoPrivilege;
    }
    for (const int priority : {kRunnerPriority, 90}) {
        run_as_runner(kRunnerPriority, [this, priority] {
            GuardedHost host{threads_, clock_, {priority, kAny}};
            EXPECT_EQ(host.open(), Status::kBadParameter);
        });
    }
    GuardedHost host{threads_, clock_, {1, kAny}};
    EXPECT_EQ(host.open(), Status::kBadParameter) << "an ordinary thread cannot guard a fixed priority";
    EXPECT_EQ(host.close(), Status::kOk);
}

TEST_F(HangTest, RunnerThatIsNotAboveTheWindowsRemovesTheirPriorityAndReportsIt) {
    verifies("SWR-PRT-041", Technique::kFaultInjection, Polarity::kViolation);
    if (!has_privilege()) {
        GTEST_SKIP() << kNoPrivilege;
    }
    for (const int priority : {kRunnerPriority - 10, 1}) {
        run_as_runner(kRunnerPriority, [this, priority] {
            GuardedHost host{threads_, clock_, {priority, kAny}};
            ASSERT_EQ(host.open(), Status::kOk);
            ASSERT_EQ(run_window(host, kProtecting, 1_s), 1U);
            ASSERT_TRUE(host.get_priority_right().is_granted);

            ASSERT_TRUE(set_priority(pthread_self(), priority).is_granted);
            static_cast<void>(hang(host));
            EXPECT_EQ(seen_, kOrdinary);
            EXPECT_FALSE(host.get_priority_right().is_granted);
            EXPECT_EQ(host.get_priority_right().system_error, EPERM);
            expect_that_the_other_window_runs(host);

            wait_until_back(host);
            for (const std::size_t window : {kProtecting, kHanging}) {
                static_cast<void>(run_window(host, window, 30_ms));
                EXPECT_EQ(seen_, kOrdinary) << "permanently";
            }
            end(host);
        });
    }
}

TEST_F(HangTest, ThreadOfAbortedWorkLosesItsPriorityUntilTheWorkReturns) {
    verifies("SWR-PRT-004", Technique::kFaultInjection, Polarity::kViolation);
    if (!has_privilege()) {
        GTEST_SKIP() << kNoPrivilege;
    }
    run_as_runner(kRunnerPriority, [this] {
        GuardedHost host{threads_, clock_, {5, kAny}};
        ASSERT_EQ(host.open(), Status::kOk);
        EXPECT_EQ(hang(host), kOrdinary) << "read from Linux, on any number of processors";
        EXPECT_EQ(seen_, (Scheduling{SCHED_FIFO, 5})) << "within its budget";
        expect_that_the_other_window_runs(host);

        wait_until_back(host);
        static_cast<void>(hang(host));
        EXPECT_EQ(seen_, (Scheduling{SCHED_FIFO, 5})) << "restored for the next work";
        EXPECT_TRUE(host.get_priority_right().is_granted);
        end(host);
    });
}

TEST_F(HangTest, PriorityThatIsNotRestoredIsReported) {
    verifies("SWR-PRT-004", Technique::kFaultInjection, Polarity::kViolation);
    if (!has_privilege() || geteuid() != 0U) {
        GTEST_SKIP() << kNoPrivilege;
    }
    EXPECT_EQ(run_in_process([this] {
                  run_as_runner(kRunnerPriority, [this] {
                      GuardedHost host{threads_, clock_, {5, kAny}};
                      ASSERT_EQ(host.open(), Status::kOk);
                      EXPECT_EQ(hang(host), kOrdinary);
                      wait_until_back(host);
                      ASSERT_TRUE(host.get_priority_right().is_granted);
                      const rlimit none{0U, 0U};
                      ASSERT_EQ(setrlimit(RLIMIT_RTPRIO, &none), 0);
                      ASSERT_EQ(setresuid(65534, 65534, 65534), 0);

                      static_cast<void>(hang(host));
                      EXPECT_EQ(seen_, kOrdinary);
                      EXPECT_FALSE(host.get_priority_right().is_granted);
                      EXPECT_EQ(host.get_priority_right().system_error, EPERM);
                      end(host);
                  });
              }),
              0);
}

TEST_F(HangTest, HostThatIsOpenedAgainHasTheRightsOfNow) {
    verifies("SWR-PRT-040", Technique::kStateTransition, Polarity::kViolation);
    if (!has_privilege() || geteuid() != 0U) {
        GTEST_SKIP() << kNoPrivilege;
    }
    EXPECT_EQ(run_in_process([this] {
                  GuardedHost host{threads_, clock_, {10, kAny}};
                  ASSERT_EQ(host.open(11), Status::kOk);
                  ASSERT_TRUE(host.get_priority_right().is_granted);
                  ASSERT_EQ(host.close(), Status::kOk);
                  const rlimit none{0U, 0U};
                  ASSERT_EQ(setrlimit(RLIMIT_RTPRIO, &none), 0);
                  ASSERT_EQ(setresuid(65534, 65534, 65534), 0);

                  EXPECT_EQ(host.open(0), Status::kOk) << "its windows have no fixed priority now";
                  EXPECT_EQ(host.get_priority_right().system_error, EPERM);
                  EXPECT_EQ(host.close(), Status::kOk);
              }),
              0);
}

TEST_F(HangTest, ThreadThatCannotLeaveItsSchedulingKeepsTheRightThatItHas) {
    verifies("SWR-PRT-040", Technique::kFaultInjection, Polarity::kViolation);
    EXPECT_EQ(run_in_process([this] {
                  const rlimit none{0U, 0U};
                  ASSERT_EQ(setrlimit(RLIMIT_NICE, &none) + setrlimit(RLIMIT_RTPRIO, &none), 0);
                  ASSERT_EQ(geteuid() == 0U ? setresuid(65534, 65534, 65534) : 0, 0);
                  ASSERT_TRUE(set_idle(pthread_self()).is_granted);
                  GuardedHost host{threads_, clock_, {}};
                  ASSERT_EQ(host.open(), Status::kOk);
                  EXPECT_EQ(run_window(host, kProtecting, 600_s), 1U);
                  EXPECT_EQ(seen_.policy, SCHED_IDLE);
                  EXPECT_TRUE(host.get_priority_right().is_granted) << "no privilege was requested";
                  EXPECT_EQ(host.close(), Status::kOk);
              }),
              0);
}

TEST_F(HangTest, OrdinaryThreadOfAbortedWorkRunsBelowAllOthersUntilTheWorkReturns) {
    verifies("SWR-PRT-042", Technique::kFaultInjection, Polarity::kViolation);
    if (!may_leave_idle()) {
        GTEST_SKIP() << "verdict=no-privilege: this host does not let a thread leave SCHED_IDLE "
                        "(CAP_SYS_NICE or ulimit -e 20)";
    }
    GuardedHost host{threads_, clock_, {}};
    ASSERT_EQ(host.open(), Status::kOk);
    EXPECT_EQ(hang(host).policy, SCHED_IDLE);
    expect_that_the_other_window_runs(host);

    wait_until_back(host);
    static_cast<void>(hang(host));
    EXPECT_EQ(seen_, kOrdinary);
    end(host);
}

/// Scheduling that the watch thread reads when it closes the outputs.
struct Outputs {
    std::atomic<bool> is_closed{false};
    Scheduling seen{};

    static void close(void* self) noexcept {
        auto& outputs = *static_cast<Outputs*>(self);
        outputs.seen = Scheduling::read(0);
        outputs.is_closed = true;
    }
    void wait(const FrameClock& clock) const {
        while (!is_closed) {
            clock.wait_until(clock.get_now() + 1_ms);
        }
    }
};

TEST(WatchSchedulingTest, WatchdogMustBeAboveTheFixedPriorityOfTheOpeningThread) {
    verifies("SWR-PRT-041", Technique::kBoundaryValues, Polarity::kViolation);
    if (!has_privilege()) {
        GTEST_SKIP() << kNoPrivilege;
    }
    run_as_runner(kRunnerPriority, [] {
        const FrameClock clock = FrameClock::starting_in(0_ms);
        Outputs outputs;
        SoftwareWatchdog sut{clock, {0_ms, 5_ms}, {&Outputs::close, &outputs, false}};
        EXPECT_EQ(sut.open({}), Status::kBadParameter);
        EXPECT_EQ(sut.open({kRunnerPriority, kAny}), Status::kBadParameter);

        ASSERT_EQ(sut.open({kRunnerPriority + 1, kAny}), Status::kOk);
        EXPECT_TRUE(sut.get_priority_right().is_granted);
        ASSERT_EQ(sut.service(clock.get_now()), Status::kOk);
        outputs.wait(clock);
        EXPECT_EQ(sut.close(), Status::kOk);
        EXPECT_EQ(outputs.seen, (Scheduling{SCHED_FIFO, kRunnerPriority + 1}));
    });
}

TEST(WatchSchedulingTest, TheLowestFixedPriorityIsOneLikeAnyOther) {
    verifies("SWR-PRT-041", Technique::kBoundaryValues, Polarity::kViolation);
    if (!has_privilege()) {
        GTEST_SKIP() << kNoPrivilege;
    }
    run_as_runner(1, [] {
        const FrameClock clock = FrameClock::starting_in(0_ms);
        Outputs outputs;
        SoftwareWatchdog watchdog{clock, {0_ms, 60_s}, {&Outputs::close, &outputs, false}};
        EXPECT_EQ(watchdog.open({1, kAny}), Status::kBadParameter);
        ASSERT_EQ(watchdog.open({2, kAny}), Status::kOk);
        EXPECT_EQ(watchdog.close(), Status::kOk);
        constexpr GridLimits kLimits{60_s, 1_ms, {60_s, 500'000}};
        GridWatch low{{}, clock, get_raw_clock(), kLimits, {&Outputs::close, &outputs}, {1, kAny}};
        EXPECT_EQ(low.open(), Status::kBadParameter);
        GridWatch above{{}, clock, get_raw_clock(), kLimits, {&Outputs::close, &outputs}, {2, kAny}};
        ASSERT_EQ(above.open(), Status::kOk);
        above.close();
        EXPECT_FALSE(outputs.is_closed);
    });
}

TEST(WatchSchedulingTest, GridWatchMustBeAboveTheFixedPriorityOfTheOpeningThread) {
    verifies("SWR-PRT-041", Technique::kBoundaryValues, Polarity::kViolation);
    if (!has_privilege()) {
        GTEST_SKIP() << kNoPrivilege;
    }
    class Idle final : public Component {
      public:
        Idle() noexcept : Component("idle") {}
    } idle;
    const auto table = system(frame(10_ms), window("only", 0_ms, 3_ms, budget(2_ms), run(idle)));
    run_as_runner(kRunnerPriority, [&table] {
        const FrameClock clock = FrameClock::starting_in(0_ms);
        std::array<GridBeat, 1U> beats{GridBeat{make_view(table), 0U}};
        constexpr GridLimits kLimits{Duration{0}, 1_ms, {100_ms, 500'000}};
        Outputs outputs;
        const OutputGate gate{&Outputs::close, &outputs};
        for (const int priority : {0, kRunnerPriority}) {
            GridWatch low{beats, clock, get_raw_clock(), kLimits, gate, {priority, kAny}};
            EXPECT_EQ(low.open(), Status::kBadParameter) << priority;
        }
        GridWatch sut{beats, clock, get_raw_clock(), kLimits, gate, {kRunnerPriority + 1, kAny}};
        ASSERT_EQ(sut.open(), Status::kOk);
        EXPECT_TRUE(sut.get_right().is_granted);
        beats[0].expect(Instant{0});
        outputs.wait(clock);
        sut.close();
        EXPECT_EQ(outputs.seen, (Scheduling{SCHED_FIFO, kRunnerPriority + 1}));
    });
}

/// A thread of start_thread() that stores its scheduling.
struct Started {
    Status status{Status::kError};
    ThreadRights rights{};
    Scheduling seen{};

    explicit Started(ThreadPlace place) noexcept {
        pthread_t thread{};
        status = start_thread(thread, &Started::run, this, place, rights);
        is_set_ = true;
        if (status == Status::kOk && pthread_join(thread, nullptr) != 0) {
            status = Status::kError;
        }
    }

  private:
    static void* run(void* self) noexcept {
        auto& started = *static_cast<Started*>(self);
        const FrameClock clock = FrameClock::starting_in(0_ms);
        while (!started.is_set_) {
            clock.wait_until(clock.get_now() + 1_ms);
        }
        started.seen = Scheduling::read(0);
        return nullptr;
    }
    std::atomic<bool> is_set_{false};
};

TEST(StartThreadTest, ThreadDoesNotInheritTheSchedulingOfItsCreator) {
    verifies("SWR-PRT-040", Technique::kEquivalenceClasses);
    if (!has_privilege()) {
        GTEST_SKIP() << kNoPrivilege;
    }
    run_as_runner(kRunnerPriority, [] {
        const Started ordinary{{}};
        EXPECT_EQ(ordinary.status, Status::kOk);
        EXPECT_EQ(ordinary.seen, kOrdinary);
        EXPECT_TRUE(ordinary.rights.priority.is_granted);
        EXPECT_TRUE(ordinary.rights.processor.is_granted);
        const Started fixed{{kRunnerPriority + 1, kAny}};
        EXPECT_EQ(fixed.seen, (Scheduling{SCHED_FIFO, kRunnerPriority + 1}));

        const Started invalid{{100, 100'000}};
        EXPECT_EQ(invalid.status, Status::kOk);
        EXPECT_EQ(invalid.seen, kOrdinary) << "invalid priority";
        EXPECT_EQ(invalid.rights.priority.system_error, EINVAL);
        EXPECT_EQ(invalid.rights.processor.system_error, EINVAL);
    });
}

/// Exit status; 0: a thread was started without privileges and from SCHED_IDLE, which it cannot leave.
int start_thread_from_idle() {
    const rlimit none{0U, 0U};
    if (setrlimit(RLIMIT_NICE, &none) != 0 || setrlimit(RLIMIT_RTPRIO, &none) != 0 ||
        (geteuid() == 0U && setresuid(65534, 65534, 65534) != 0) || !set_idle(pthread_self()).is_granted) {
        return 2;
    }
    const Started started{{5, kAny}};
    const Right& priority = started.rights.priority;
    const bool is_reported = !priority.is_granted && priority.system_error == EPERM;
    const bool is_started = started.status == Status::kOk && started.seen.policy == SCHED_IDLE;
    return is_reported && is_started && !may_leave_idle() ? 0 : 1;
}

TEST(StartThreadTest, WithoutAnyPrivilegeAThreadStartsAndTheDenialIsReported) {
    verifies("SWR-PRT-040", Technique::kFaultInjection, Polarity::kViolation);
    const pid_t child = fork();
    if (child == 0) {
        _exit(start_thread_from_idle());
    }
    int status = -1;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    EXPECT_TRUE(WIFEXITED(status));
    EXPECT_EQ(WEXITSTATUS(status), 0);
}

}  // namespace
}  // namespace mamori::ports::posix_rt
