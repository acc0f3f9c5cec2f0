// SPDX-License-Identifier: Apache-2.0
// Goal: each thread of a machine has its priority and its signals, the calling thread has its own again after
// a run, and the report tells each denial. Method: a device looks at each thread of the process during a
// frame; an ordinary user without a limit of the priority (RLIMIT_RTPRIO) is denied each.
#include <gtest/gtest.h>
#include <sched.h>
#include <sys/resource.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <fstream>
#include <memory>
#include <set>
#include <string>
#include <thread>
#include <utility>

#include "mamori/kernel/system/system.hpp"
#include "mamori/ports/posix_rt/machine.hpp"
#include "mamori/trace/verifies.hpp"
#include "support/patient_options.hpp"
#include "support/refused_call.hpp"
#include "support/threads.hpp"

namespace mamori::ports::posix_rt {
namespace {

using namespace verification;
using literals::operator""_ms;

constexpr int kPriority = 50;

/// Notes the priority of the thread that starts and stops it.
class Witness final : public Component {
  public:
    constexpr explicit Witness(const char* name) noexcept : Component(name) {}
    int starting{-1};
    Status on_startup(ContextHandle) noexcept override {
        starting = get_own_priority();
        return Status::kOk;
    }
};

#define MAMORI_TEST_SYSTEM(name)         \
    Witness g_witness_##name{"witness"}; \
    constexpr auto name =                \
        system(frame(10_ms), window("idle", 2_ms, 4_ms, budget(4_ms), run(g_witness_##name)))

MAMORI_TEST_SYSTEM(kPlaced);
MAMORI_TEST_SYSTEM(kBlocked);
MAMORI_TEST_SYSTEM(kLimited);
MAMORI_TEST_SYSTEM(kElsewhere);
MAMORI_TEST_SYSTEM(kBelow);
MAMORI_TEST_SYSTEM(kUnserved);
MAMORI_TEST_SYSTEM(kLocked);

Witness g_first{"first"};
Witness g_second{"second"};
constexpr auto kTwoCores = system(frame(10_ms), window("first", 2_ms, 4_ms, budget(4_ms), run(g_first)),
                                  window("second", 2_ms, 4_ms, core(1U), budget(4_ms), run(g_second)));
constexpr uid_t kNobodyElse = 61'234U;  ///< a user without processes

/// @return fixed priority of a thread, and whether it blocks SIGINT and SIGTERM.
std::pair<int, bool> look_at(pid_t thread) {
    sched_param parameters{};
    EXPECT_EQ(::sched_getparam(thread, &parameters), 0);
    std::ifstream status{"/proc/self/task/" + std::to_string(thread) + "/status"};
    bool is_blocking = false;
    for (std::string line; std::getline(status, line);) {
        if (line.compare(0U, 7U, "SigBlk:") == 0) {
            const unsigned long long set = std::stoull(line.substr(7U), nullptr, 16);
            const unsigned long long stop = (1ULL << (SIGINT - 1)) | (1ULL << (SIGTERM - 1));
            is_blocking = (set & stop) == stop;
        }
    }
    return {parameters.sched_priority, is_blocking};
}

bool may_have_a_priority() {
    bool is_granted = false;
    std::thread{[&] { is_granted = set_priority(pthread_self(), kPriority + 10).is_granted; }}.join();
    return is_granted;
}

MachineOptions make_rights_options() {
    MachineOptions options = make_options();
    options.priority = kPriority;
    return options;
}

TEST(MachineRightsTest, EachThreadHasItsPriorityAndOnlyTheRunnersAndTheWatchTakeStopSignals) {
    verifies("SWR-PRT-070", Technique::kRequirementsBased, Polarity::kNominal);
    if (!may_have_a_priority()) {
        GTEST_SKIP()
            << "verdict=no-privilege: this host grants no fixed priority (CAP_SYS_NICE or ulimit -r)";
    }
    static Machine<kPlaced> sut{make_rights_options()};
    const pid_t caller = ::gettid();
    const std::set<pid_t> before = find_threads();
    std::multiset<std::pair<int, bool>> seen;

    ASSERT_EQ(sut.run(1U,
                      [&](std::uint64_t) {
                          while (!look_at(caller).second) {  // it waits for the end of the run
                              std::this_thread::sleep_for(std::chrono::milliseconds{1});
                          }
                          for (const pid_t thread : find_threads()) {
                              if (before.count(thread) == 0U) {
                                  seen.insert(look_at(thread));
                              }
                          }
                      }),
              Status::kOk);

    EXPECT_EQ(seen, (std::multiset<std::pair<int, bool>>{{45, true}, {50, false}, {55, false}, {60, true}}))
        << "window, runner, watch, watchdog";
    EXPECT_EQ(g_witness_kPlaced.starting, 45) << "the action runs on the thread of the window";
    EXPECT_TRUE(sut.get_report().priority.is_granted) << sut.get_report().priority.system_error;
    EXPECT_EQ(sut.get_report().priority.system_error, 0);
    EXPECT_TRUE(sut.get_report().processor.is_granted);
    EXPECT_EQ(sut.get_report().processor.system_error, 0);
}

TEST(MachineRightsTest, TheCallingThreadHasItsSchedulingAndItsSignalsAgainAfterARun) {
    verifies("SWR-PRT-040", Technique::kStateTransition);
    static Machine<kBlocked> sut{make_rights_options()};
    sigset_t own{};
    sigset_t before{};
    ASSERT_EQ(sigemptyset(&own) + sigaddset(&own, SIGUSR2), 0);
    ASSERT_EQ(::pthread_sigmask(SIG_BLOCK, &own, &before), 0);

    for (const int policy : {SCHED_OTHER, SCHED_BATCH}) {
        const sched_param none{};
        ASSERT_EQ(::pthread_setschedparam(pthread_self(), policy, &none), 0);
        EXPECT_EQ(sut.run(1U), Status::kOk);
        EXPECT_EQ(::sched_getscheduler(0), policy);
        EXPECT_EQ(get_own_priority(), 0);
    }
    ASSERT_TRUE(set_priority(pthread_self(), 0).is_granted);
    sigset_t after{};
    ASSERT_EQ(::pthread_sigmask(SIG_SETMASK, &before, &after), 0);
    EXPECT_EQ(sigismember(&after, SIGUSR2), 1);
    EXPECT_EQ(sigismember(&after, SIGINT), 0);
    EXPECT_EQ(sigismember(&after, SIGTERM), 0);
}

TEST(MachineRightsTest, APriorityThatIsDeniedIsReported) {
    verifies("SWR-PRT-002", Technique::kFaultInjection, Polarity::kViolation);
    EXPECT_EQ(run_in_process([] {
                  const rlimit none{0U, 0U};
                  ASSERT_EQ(::setrlimit(RLIMIT_RTPRIO, &none), 0);
                  ASSERT_EQ(::geteuid() == 0U ? ::setresuid(65534U, 65534U, 65534U) : 0, 0);
                  const auto sut = std::make_unique<Machine<kLimited>>(make_rights_options());
                  EXPECT_EQ(sut->run(1U), Status::kOk) << describe(sut->get_report()).c_str();
                  EXPECT_FALSE(sut->get_report().priority.is_granted);
                  EXPECT_EQ(sut->get_report().priority.system_error, EPERM);
              }),
              0);
}

TEST(MachineRightsTest, AProcessorThatDoesNotExistIsReported) {
    verifies("SWR-PRT-002", Technique::kFaultInjection, Polarity::kViolation);
    static constexpr std::array<int, 1U> kNowhere{100'000};
    MachineOptions options = make_rights_options();
    options.processors = kNowhere;
    const auto sut = std::make_unique<Machine<kElsewhere>>(options);

    EXPECT_EQ(sut->run(1U), Status::kOk) << describe(sut->get_report()).c_str();
    EXPECT_FALSE(sut->get_report().processor.is_granted);
    EXPECT_EQ(sut->get_report().processor.system_error, EINVAL);
}

TEST(MachineRightsTest, EachThreadThatCannotBeStartedNamesItsStepAndNoneIsLeft) {
    verifies("SWR-PRT-070", Technique::kFaultInjection, Polarity::kViolation);
    if (::geteuid() != 0U) {
        GTEST_SKIP() << "verdict=no-privilege: only root may become a user without other threads";
    }
    struct Case {
        rlim_t threads;  ///< that the user may have
        MachineStep step;
    };
    for (const Case example : {Case{2U, MachineStep::kWindowThreads}, Case{3U, MachineStep::kWatch},
                               Case{4U, MachineStep::kWatchdog}, Case{5U, MachineStep::kRunnerThreads},
                               Case{6U, MachineStep::kRunnerThreads}, Case{7U, MachineStep::kNone}}) {
        EXPECT_EQ(run_in_process([&example] {
                      const rlimit limit{example.threads, example.threads};
                      ASSERT_EQ(::setrlimit(RLIMIT_NPROC, &limit), 0);
                      ASSERT_EQ(::setresuid(kNobodyElse, kNobodyElse, kNobodyElse), 0);
                      g_closed = 0;
                      const auto sut = std::make_unique<Machine<kTwoCores>>(make_rights_options());
                      const bool is_started = example.step == MachineStep::kNone;
                      EXPECT_EQ(sut->run(is_started ? 1U : MachineRun::kAllFrames),
                                is_started ? Status::kOk : Status::kOutOfResources);
                      EXPECT_EQ(sut->get_report().failed_step, example.step)
                          << describe(sut->get_report()).c_str();
                      EXPECT_EQ(g_closed, 1);
                      EXPECT_EQ(find_threads().size(), 1U);
                  }),
                  0)
            << example.threads;
    }
}

TEST(MachineRightsTest, LockedMemoryIsReported) {
    verifies("SWR-PRT-002", Technique::kBackToBack);
    EXPECT_EQ(run_in_process([] {
                  const Right expected = lock_memory(4096U);
                  const auto sut = std::make_unique<Machine<kLocked>>(make_rights_options());
                  EXPECT_EQ(sut->run(1U), Status::kOk);
                  EXPECT_EQ(sut->get_report().memory.is_granted, expected.is_granted);
                  EXPECT_EQ(sut->get_report().memory.system_error, expected.system_error);
              }),
              0);
}

TEST(MachineRightsTest, AWatchThatIsNotAboveTheCallingThreadEndsTheRunWithClosedOutputs) {
    verifies("SWR-PRT-041", Technique::kBoundaryValues, Polarity::kViolation);
    if (!may_have_a_priority()) {
        GTEST_SKIP()
            << "verdict=no-privilege: this host grants no fixed priority (CAP_SYS_NICE or ulimit -r)";
    }
    static Machine<kBelow> sut{make_rights_options()};
    std::thread{[] {
        for (const int own : {55, 54}) {
            g_closed = 0;
            ASSERT_TRUE(set_priority(pthread_self(), own).is_granted);
            EXPECT_EQ(sut.run(1U), own == 55 ? Status::kBadParameter : Status::kOk);
            EXPECT_EQ(sut.get_report().failed_step, own == 55 ? MachineStep::kWatch : MachineStep::kNone);
            EXPECT_EQ(get_own_priority(), own);
            EXPECT_EQ(g_closed, 1);
        }
    }}.join();
}

TEST(MachineRightsTest, AWatchdogWhoseDeviceIsClosedEndsTheRunWithClosedOutputs) {
    verifies("SWR-PRT-070", Technique::kFaultInjection, Polarity::kViolation);
    WatchdogDevice closed;
    MachineOptions options = make_rights_options();
    options.device = &closed;
    const auto sut = std::make_unique<Machine<kUnserved>>(options);
    g_closed = 0;

    EXPECT_EQ(sut->run(1U), Status::kPreconditionNotMet);
    EXPECT_EQ(sut->get_report().failed_step, MachineStep::kWatchdog);
    EXPECT_EQ(sut->get_report().openings.opened, 0U);
    EXPECT_EQ(g_closed, 1);
}

}  // namespace
}  // namespace mamori::ports::posix_rt
