// SPDX-License-Identifier: Apache-2.0
// Goal: a machine runs a table in real time and closes the outputs before every end. Method: real threads and
// signals; components that note their cycles, fail or hang on request. A crash, an expired watchdog and a
// hang end a child process. Limits are long, so that a slow host changes no result; counts of windows are
// compared only with the counts of the machine itself.
#include "mamori/ports/posix_rt/machine.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <thread>
#include <vector>

#include "mamori/kernel/system/system.hpp"
#include "mamori/ports/posix_rt/crash_note.hpp"
#include "mamori/trace/verifies.hpp"
#include "support/machine_records.hpp"
#include "support/patient_options.hpp"

namespace mamori::ports::posix_rt {
namespace {

using namespace verification;
using literals::operator""_ms;
using literals::operator""_s;

class Counter final : public Component {
  public:
    constexpr Counter() noexcept : Component("counter") {}
    OutPort<std::int64_t> out{*this, "out"};
    using Ports = mamori::Ports<&Counter::out>;
    Status starts{Status::kOk};
    Status stops{Status::kOk};
    std::atomic<bool> is_to_hang{false};
    std::atomic<bool> is_to_crash{false};
    std::atomic<std::int64_t> last_start_ns{-1};

    Status on_activated(ContextHandle) noexcept override { return starts; }
    Status on_deactivated(ContextHandle) noexcept override { return stops; }
    Status on_execute(ContextHandle context) noexcept override {
        last_start_ns.store(context.now.ns);
        while (is_to_hang) {
            std::this_thread::yield();
        }
        if (is_to_crash) {
            std::raise(SIGSEGV);
        }
        out.write(out.get_published() + 1);
        return Status::kOk;
    }
};
class Adder final : public Component {
  public:
    constexpr Adder() noexcept : Component("adder") {}
    InPort<std::int64_t> in{*this, "in"};
    OutPort<std::int64_t> out{*this, "out"};
    using Ports = mamori::Ports<&Adder::in, &Adder::out>;

    Status on_execute(ContextHandle) noexcept override {
        out.write(out.get_published() + in.read());
        return Status::kOk;
    }
};

// One table per test: a component belongs to one executive as long as it is alive.
#define MAMORI_TEST_SYSTEM(name) \
    Counter g_counter_##name;    \
    constexpr auto name =        \
        system(frame(10_ms), window("count", 2_ms, 4_ms, budget(4_ms), run(g_counter_##name)))

MAMORI_TEST_SYSTEM(kRuns);
MAMORI_TEST_SYSTEM(kRepeats);
MAMORI_TEST_SYSTEM(kCloses);
MAMORI_TEST_SYSTEM(kWithoutOptions);
MAMORI_TEST_SYSTEM(kStops);
MAMORI_TEST_SYSTEM(kSignals);
MAMORI_TEST_SYSTEM(kManySignals);
MAMORI_TEST_SYSTEM(kNested);
MAMORI_TEST_SYSTEM(kRefused);
MAMORI_TEST_SYSTEM(kFailsAtStart);
MAMORI_TEST_SYSTEM(kFailsAtStop);
MAMORI_TEST_SYSTEM(kHangs);
MAMORI_TEST_SYSTEM(kReturnsLate);
MAMORI_TEST_SYSTEM(kExpires);
MAMORI_TEST_SYSTEM(kCrashes);
MAMORI_TEST_SYSTEM(kWatched);
MAMORI_TEST_SYSTEM(kRecorded);

class Actor final : public Component {
  public:
    constexpr Actor() noexcept : Component("actor") {}
    void (*act)(){nullptr};
    Status on_execute(ContextHandle) noexcept override {
        act();
        return Status::kOk;
    }
};
Actor g_stopping;
Counter g_following;
constexpr auto kTwoWindows =
    system(frame(40_ms), window("stopping", 0_ms, 15_ms, budget(15_ms), run(g_stopping)),
           window("following", 20_ms, 15_ms, budget(15_ms), run(g_following)));

Counter g_near;
Adder g_far;
Crossing<std::int64_t> g_crossing;
constexpr auto kTwoCores =
    system(frame(40_ms), publication_margin(5_ms), window("near", 0_ms, 15_ms, budget(15_ms), run(g_near)),
           window("far", 20_ms, 15_ms, core(1U), budget(15_ms), run(g_far)),
           connect(g_near.out, g_far.in, through(g_crossing), any_age()));

void tell_closing(void*) noexcept {
    static_cast<void>(::write(STDERR_FILENO, "closed\n", 7));
}

struct SpyDevices final : Devices {
    void sample(std::uint64_t frame, Instant start) noexcept override {
        sampled.push_back(frame);
        starts.push_back(start.ns);
        thread = std::this_thread::get_id();
        stack_t stack{};
        static_cast<void>(::sigaltstack(nullptr, &stack));
        has_crash_stack = stack.ss_flags != SS_DISABLE;
        std::this_thread::sleep_for(std::chrono::microseconds{200});
    }
    void apply(std::uint64_t frame, Instant, Duration) noexcept override {
        applied.push_back(frame);
        std::this_thread::sleep_for(std::chrono::microseconds{100});
    }
    std::vector<std::uint64_t> sampled;
    std::vector<std::uint64_t> applied;
    std::vector<std::int64_t> starts;
    std::thread::id thread{};
    bool has_crash_stack{false};
};

TEST(MachineTest, DevicesAreCalledOncePerFrameAndMeasuredAndARunContinuesTheTimeLine) {
    verifies("SWR-PRT-071", Technique::kRequirementsBased, Polarity::kNominal);
    static Machine<kRuns> sut{make_options()};
    SpyDevices devices;

    ASSERT_EQ(sut.run(3U, devices), Status::kOk) << describe(sut.get_report().failed_step);

    EXPECT_EQ(devices.sampled, (std::vector<std::uint64_t>{0U, 1U, 2U}));
    EXPECT_EQ(devices.applied, devices.sampled);
    EXPECT_EQ(devices.starts, (std::vector<std::int64_t>{0, 10'000'000, 20'000'000}));
    EXPECT_NE(devices.thread, std::this_thread::get_id());
    EXPECT_TRUE(devices.has_crash_stack);
    const MachineReport& report = sut.get_report();
    EXPECT_EQ(report.openings.opened, 3U);
    EXPECT_GT(report.openings.worst_lateness, Duration{0});
    EXPECT_LT(report.openings.worst_lateness, 3600_s);
    EXPECT_GE(report.longest_sample.ns, 200'000);
    EXPECT_GE(report.longest_apply.ns, 100'000);
    EXPECT_EQ(g_counter_kRuns.out.get_published(),
              static_cast<std::int64_t>(3U - report.openings.overran - report.openings.missed));

    ASSERT_EQ(sut.run(2U, devices), Status::kOk);
    ASSERT_EQ(devices.sampled.size(), 5U);
    EXPECT_GT(devices.sampled[3], 2U);
    EXPECT_EQ(devices.sampled[4], devices.sampled[3] + 1U);
    EXPECT_EQ(sut.get_report().openings.opened, 5U);
}

TEST(MachineTest, ALaterRunBeginsAfterItsLead) {
    verifies("SWR-PRT-071", Technique::kBoundaryValues, Polarity::kNominal);
    MachineOptions options = make_options();
    options.lead = 95_ms;
    static Machine<kRepeats> sut{options};
    SpyDevices devices;

    ASSERT_EQ(sut.run(3U, devices), Status::kOk);
    ASSERT_EQ(sut.run(1U, devices), Status::kOk);
    ASSERT_EQ(devices.starts.size(), 4U);
    EXPECT_GE(devices.starts[3], devices.starts[2] + options.lead.ns);
}

TEST(MachineTest, EndOfEachRunClosesTheOutputsOnce) {
    verifies("SWR-PRT-073", Technique::kRequirementsBased, Polarity::kNominal);
    static Machine<kCloses> sut{make_options()};
    g_closed = 0;
    int closed = -1;

    ASSERT_EQ(sut.run(1U, [&closed](std::uint64_t) { closed = g_closed; }), Status::kOk);
    EXPECT_EQ(closed, 0);
    EXPECT_EQ(g_closed, 1);
    ASSERT_EQ(sut.run(1U), Status::kOk);
    EXPECT_EQ(g_closed, 2);
}

TEST(MachineTest, SystemWithoutOutputsRuns) {
    verifies("SWR-PRT-070", Technique::kEquivalenceClasses, Polarity::kNominal);
    static Machine<kWithoutOptions> sut;

    const Status status = sut.run(1U);

    // A host that stalls for longer than the default limits causes a finding.
    EXPECT_TRUE(status == Status::kOk || sut.get_report().failed_step == MachineStep::kFrames);
    EXPECT_EQ(sut.get_report().signal, 0);
}

TEST(MachineTest, TwoCoresExchangeTheValuesOfTheirPlannedInstants) {
    verifies("SWR-PRT-070", Technique::kBackToBack, Polarity::kNominal);
    static Machine<kTwoCores> sut{make_options()};
    std::vector<std::int64_t> values;

    ASSERT_EQ(sut.run(5U, [&values](std::uint64_t) { values.push_back(g_near.out.get_published()); }),
              Status::kOk);

    const OpeningCounts& counts = sut.get_report().openings;
    EXPECT_EQ(counts.opened, 10U);
    EXPECT_EQ(values.size(), 5U);
    if (counts.overran + counts.missed == 0U) {
        EXPECT_EQ(values, (std::vector<std::int64_t>{1, 2, 3, 4, 5}));
        EXPECT_EQ(g_far.out.get_published(), 15);
    }
}

TEST(MachineTest, RequestedStopEndsTheRunAndAnEarlierRequestPreventsIt) {
    verifies("SWR-PRT-070", Technique::kRequirementsBased, Polarity::kNominal);
    static Machine<kStops> sut{make_options()};

    sut.request_stop();
    ASSERT_EQ(sut.run(), Status::kOk);
    EXPECT_EQ(sut.get_report().openings.opened, 0U);
    std::uint64_t last = 0U;
    ASSERT_EQ(sut.run(MachineRun::kAllFrames,
                      [&last](std::uint64_t frame) {
                          last = frame;
                          if (frame % 4U == 3U) {
                              sut.request_stop();
                          }
                      }),
              Status::kOk);
    EXPECT_EQ(last % 4U, 3U);
    EXPECT_EQ(sut.get_report().signal, 0);
}

std::atomic<int> g_forwarded{0};
void note_forwarded(int signal) {
    g_forwarded = signal;
}

TEST(MachineTest, SignalClosesTheOutputsAtOnceAndTheHandlerOfTheApplicationFollows) {
    verifies("SWR-PRT-072", Technique::kRequirementsBased, Polarity::kNominal);
    static Machine<kSignals> sut{make_options()};
    struct sigaction own{};
    struct sigaction before{};
    own.sa_handler = &note_forwarded;
    ASSERT_EQ(sigaction(SIGTERM, &own, &before), 0);
    g_closed = 0;
    g_forwarded = 0;
    int closed_in_frame = -1;
    int forwarded_in_frame = -1;
    std::uint64_t frames = 0U;

    ASSERT_EQ(sut.run(MachineRun::kAllFrames,
                      [&](std::uint64_t) {
                          if (++frames == 2U) {
                              static_cast<void>(::kill(::getpid(), SIGTERM));
                              while (g_closed == 0) {
                                  std::this_thread::yield();
                              }
                              closed_in_frame = g_closed;
                              forwarded_in_frame = g_forwarded;
                          }
                      }),
              Status::kOk);

    EXPECT_EQ(frames, 2U);
    EXPECT_EQ(closed_in_frame, 1);
    EXPECT_EQ(forwarded_in_frame, 0);
    EXPECT_EQ(g_forwarded, SIGTERM);
    EXPECT_EQ(g_closed, 1);
    EXPECT_EQ(sut.get_report().signal, SIGTERM);
    EXPECT_GE(sut.get_report().until_closed.ns, 0);
    struct sigaction now{};
    ASSERT_EQ(sigaction(SIGTERM, &before, &now), 0);
    EXPECT_EQ(now.sa_handler, &note_forwarded);
}

TEST(MachineTest, NoWindowStartsAfterTheFrameOfASignalAtAnyInstant) {
    verifies("SWR-PRT-072", Technique::kErrorGuessing, Polarity::kViolation);
    static Machine<kManySignals> sut{make_options()};
    unsigned random = 1U;
    for (int i = 0; i < 50; ++i) {
        random = random * 1664525U + 1013904223U;
        const auto delay = std::chrono::microseconds{random % 30'000U};
        std::atomic<bool> is_running{false};
        std::thread sender{[&] {
            while (!is_running) {
                std::this_thread::yield();
            }
            std::this_thread::sleep_for(delay);
            static_cast<void>(::kill(::getpid(), SIGINT));
        }};
        g_counter_kManySignals.last_start_ns = -1;
        ASSERT_EQ(sut.run(MachineRun::kAllFrames, [&](std::uint64_t) { is_running = true; }), Status::kOk);
        sender.join();

        EXPECT_EQ(sut.get_report().signal, SIGINT);
        const std::int64_t frame_of_signal = sut.get_report().signalled.ns / 10'000'000;
        EXPECT_LE(g_counter_kManySignals.last_start_ns.load() / 10'000'000, frame_of_signal) << "run " << i;
    }
}

TEST(MachineTest, SecondMachineOfTheProcessIsRefusedWhileTheFirstRuns) {
    verifies("SWR-PRT-070", Technique::kErrorGuessing, Polarity::kViolation);
    static Machine<kNested> outer{make_options()};
    static Machine<kRefused> inner{make_options()};
    Status nested = Status::kOk;

    ASSERT_EQ(outer.run(1U, [&nested](std::uint64_t) { nested = inner.run(1U); }), Status::kOk);

    EXPECT_EQ(nested, Status::kPreconditionNotMet);
    EXPECT_EQ(inner.get_report().failed_step, MachineStep::kSignals);
    EXPECT_EQ(inner.run(1U), Status::kOk);
}

TEST(MachineTest, FailureOfAComponentNamesTheStep) {
    verifies("SWR-PRT-070", Technique::kFaultInjection, Polarity::kViolation);
    static Machine<kFailsAtStart> starts{make_options()};
    static Machine<kFailsAtStop> stops{make_options()};
    SpyDevices devices;
    g_closed = 0;
    g_counter_kFailsAtStart.starts = Status::kUnsupported;
    g_counter_kFailsAtStop.stops = Status::kOutOfResources;

    EXPECT_EQ(starts.run(1U, devices), Status::kUnsupported);
    EXPECT_EQ(starts.get_report().failed_step, MachineStep::kStart);
    EXPECT_EQ(g_closed, 1);
    EXPECT_TRUE(devices.sampled.empty());
    EXPECT_EQ(stops.run(1U, devices), Status::kOutOfResources);
    EXPECT_EQ(stops.get_report().failed_step, MachineStep::kStop);
    EXPECT_EQ(devices.applied.size(), 1U);
}

TEST(MachineTest, WorkThatHangsAtTheEndIsReportedAndTheNextRunIsRefusedUntilItReturns) {
    verifies("SWR-PRT-070", Technique::kFaultInjection, Polarity::kViolation);
    static Machine<kHangs> sut{make_options()};
    g_counter_kHangs.is_to_hang = true;

    EXPECT_EQ(sut.run(3U), Status::kPreconditionNotMet);
    EXPECT_EQ(sut.get_report().failed_step, MachineStep::kStop);
    EXPECT_EQ(sut.get_report().openings.overran + sut.get_report().openings.missed, 3U);
    EXPECT_EQ(sut.run(1U), Status::kPreconditionNotMet);
    EXPECT_EQ(sut.get_report().failed_step, MachineStep::kWindowThreads);

    g_counter_kHangs.is_to_hang = false;
    Status status = Status::kPreconditionNotMet;
    for (int i = 0; i < 500 && status != Status::kOk; ++i) {  // until the work has returned
        std::this_thread::sleep_for(std::chrono::milliseconds{10});
        status = sut.run(1U);
    }
    EXPECT_EQ(status, Status::kOk);
}

TEST(MachineTest, WorkThatReturnsSoonAfterTheEndIsNoFailure) {
    verifies("SWR-PRT-070", Technique::kBoundaryValues, Polarity::kNominal);
    static Machine<kReturnsLate> sut{make_options()};
    Counter& counter = g_counter_kReturnsLate;
    bool is_shown = false;
    // Again if the host stalled: a window was missed, or a second was over.
    for (int i = 0; i < 10 && !is_shown; ++i) {
        const std::uint64_t before = sut.get_report().openings.overran;
        std::atomic<bool> has_ended{false};
        counter.last_start_ns = -1;
        counter.is_to_hang = true;
        std::thread releaser{[&] {
            while (counter.last_start_ns < 0 && !has_ended) {
                std::this_thread::yield();
            }
            std::this_thread::sleep_for(std::chrono::milliseconds{100});
            counter.is_to_hang = false;
        }};
        const Status status = sut.run(1U);
        has_ended = true;
        releaser.join();
        is_shown = status == Status::kOk && sut.get_report().openings.overran > before;
    }
    EXPECT_TRUE(is_shown);
}

TEST(MachineTest, AStopIsAtTheEndOfTheFrame) {
    verifies("SWR-PRT-070", Technique::kBoundaryValues, Polarity::kNominal);
    static Machine<kTwoWindows> sut{make_options()};
    static const auto request = [] { sut.request_stop(); };
    g_stopping.act = [] { request(); };

    ASSERT_EQ(sut.run(), Status::kOk);

    EXPECT_GE(sut.get_report().openings.opened, 2U);
    EXPECT_EQ(sut.get_report().openings.opened % 2U, 0U) << "the second window of the frame opens, too";
}

TEST(MachineTest, FindingOfTheScheduleWatchClosesTheOutputs) {
    verifies("SWR-PRT-073", Technique::kFaultInjection, Polarity::kViolation);
    MachineOptions options = make_options();
    options.watch.lateness = 20_ms;
    static Machine<kWatched> sut{options};
    g_closed = 0;
    int closed = 0;

    EXPECT_EQ(sut.run(MachineRun::kAllFrames,
                      [&closed](std::uint64_t) {
                          std::this_thread::sleep_for(std::chrono::milliseconds{200});
                          closed = g_closed;
                      }),
              Status::kError);

    EXPECT_EQ(closed, 1);
    EXPECT_EQ(g_closed, 1);
    EXPECT_EQ(sut.get_report().failed_step, MachineStep::kFrames);
    EXPECT_EQ(sut.get_report().finding.fault, GridFault::kOverdue);
}

MachineOptions make_guarded_options() {
    MachineOptions options = make_options();
    options.outputs = {&tell_closing, nullptr};
    options.watchdog_timeout = 300_ms;
    return options;
}

TEST(MachineDeathTest, ThreadThatHangsExpiresTheWatchdog) {
    verifies("SWR-PRT-074", Technique::kFaultInjection, Polarity::kViolation);
    static Machine<kExpires> sut{make_guarded_options()};

    EXPECT_EXIT(static_cast<void>(sut.run(5U,
                                          [](std::uint64_t frame) {
                                              while (frame == 0U) {
                                                  std::this_thread::yield();
                                              }
                                          })),
                testing::KilledBySignal(SIGABRT), "^closed\n$");
}

TEST(MachineDeathTest, CrashOfAComponentClosesTheOutputs) {
    verifies("SWR-PRT-073", Technique::kFaultInjection, Polarity::kViolation);
    static Machine<kCrashes> sut{make_guarded_options()};

    EXPECT_EXIT(
        {
            g_counter_kCrashes.is_to_crash = true;
            static_cast<void>(sut.run());
        },
        testing::KilledBySignal(SIGSEGV), "^closed\n$");
}

TEST(MachineTest, RecorderHasStartStopAndSignal) {
    verifies("SWR-PRT-072", Technique::kRequirementsBased, Polarity::kNominal);
    const std::string path = testing::TempDir() + "machine.rec";
    static_cast<void>(std::remove(path.c_str()));
    MachineOptions options = make_options();
    options.recorder = path.c_str();
    options.recorder_capacity = 16U;
    static std::array<Event, 4U> storage{};
    static EventLog log{storage};
    options.event_log = &log;
    static Machine<kRecorded> sut{options};

    ASSERT_EQ(sut.run(3U,
                      [](std::uint64_t frame) {
                          log.write(Instant{7}, Severity::kWarning, 1U, 2U, static_cast<std::int64_t>(frame));
                          if (frame == 1U) {
                              static_cast<void>(::raise(SIGINT));
                          }
                      }),
              Status::kOk);

    MappedFile again;  // the machine has the file: another owner is refused
    EXPECT_EQ(again.open(path.c_str(), calc_recorder_file_size(16U)), Status::kError);
    std::vector<int> codes;
    for (const FlightRecord& record : read_machine_records(path)) {
        codes.push_back(record.code);
    }
    EXPECT_EQ(codes, (std::vector<int>{1, 2, 3, 5}));
    static_cast<void>(std::remove(path.c_str()));
}

}  // namespace
}  // namespace mamori::ports::posix_rt
