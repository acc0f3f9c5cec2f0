// SPDX-License-Identifier: Apache-2.0
// Goal: a machine rejects options that cannot work before it starts anything, and names each step of a run.
// Method: one option out of its range at a time.
#include "mamori/ports/posix_rt/machine_options.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdio>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "mamori/kernel/system/system.hpp"
#include "mamori/ports/posix_rt/crash_handlers.hpp"
#include "mamori/ports/posix_rt/crash_note.hpp"
#include "mamori/ports/posix_rt/machine.hpp"
#include "mamori/trace/verifies.hpp"
#include "support/patient_options.hpp"

namespace mamori::ports::posix_rt {
namespace {

using namespace verification;
using literals::operator""_ms;
using literals::operator""_s;

class Idle final : public Component {
  public:
    constexpr Idle() noexcept : Component("idle") {}
};

Idle g_idle;
constexpr auto kRefused = system(frame(10_ms), window("idle", 2_ms, 4_ms, budget(4_ms), run(g_idle)));

TEST(MachineOptionsTest, OptionOutsideItsRangeIsRefused) {
    verifies("SWR-PRT-070", Technique::kBoundaryValues, Polarity::kViolation);
    const auto run = [](const MachineOptions& options, std::uint64_t frames = 1U) {
        const auto sut = std::make_unique<Machine<kRefused>>(options);
        const Status status = sut->run(frames);
        const bool is_named = sut->get_report().failed_step == MachineStep::kOptions;
        EXPECT_EQ(is_named, status == Status::kBadParameter);
        return status;
    };
    MachineOptions options = make_options();
    EXPECT_EQ(run(options, 0U), Status::kBadParameter);
    options.priority = MachineOptions::kPriorityMin - 1;
    EXPECT_EQ(run(options), Status::kBadParameter);
    options.priority = MachineOptions::kPriorityMax + 1;
    EXPECT_EQ(run(options), Status::kBadParameter);
    options.priority = std::numeric_limits<int>::min();
    EXPECT_EQ(run(options), Status::kBadParameter);
    options = make_options();
    options.window_stack = kThreadStackMin - 1U;
    EXPECT_EQ(run(options), Status::kBadParameter);
    options = make_options();
    options.runner_stack = kThreadStackMin - 1U;
    EXPECT_EQ(run(options), Status::kBadParameter);
    options = make_options();
    options.lead = Duration{std::numeric_limits<std::int64_t>::min()};
    EXPECT_EQ(run(options), Status::kBadParameter);
    options.lead = Duration{0};
    EXPECT_EQ(run(options), Status::kBadParameter);
    options = make_options();
    options.watch.lateness = Duration{-1};
    EXPECT_EQ(run(options), Status::kBadParameter);
    options = make_options();
    options.watch.period = Duration{0};
    EXPECT_EQ(run(options), Status::kBadParameter);
    options = make_options();
    options.watch.rate.span = Duration{0};
    EXPECT_EQ(run(options), Status::kBadParameter);
    options = make_options();
    options.watch.rate.limit_ppm = 0;
    EXPECT_EQ(run(options), Status::kBadParameter);
    options = make_options();
    options.watchdog_timeout = 29_ms;  // lead, two frames and two polls
    EXPECT_EQ(run(options), Status::kBadParameter);
    options.watchdog_timeout = 29_ms + Duration{1};
    EXPECT_EQ(run(options), Status::kBadParameter);
    options.watchdog_timeout = Duration{0};
    EXPECT_EQ(run(options), Status::kBadParameter);
    options.watchdog_timeout = Duration{std::numeric_limits<std::int64_t>::min()};
    EXPECT_EQ(run(options), Status::kBadParameter);
    options = make_options();
    options.recorder = "unused.rec";
    options.recorder_capacity = 0U;
    EXPECT_EQ(run(options), Status::kBadParameter);
}

TEST(MachineOptionsTest, OptionAtTheEndOfItsRangeIsNotRefused) {
    verifies("SWR-PRT-070", Technique::kBoundaryValues, Polarity::kNominal);
    CrashHandlers taken;  // ends each run after the check of its options
    ASSERT_EQ(taken.install({[](void*) noexcept {}, nullptr, {}, 0U, FrameClock::at_epoch(0)}), Status::kOk);
    const std::string path = ::testing::TempDir() + "mamori_options_" + std::to_string(::getpid());
    const auto run = [](const MachineOptions& options) {
        const auto sut = std::make_unique<Machine<kRefused>>(options);
        EXPECT_EQ(sut->run(1U), Status::kPreconditionNotMet);
        return sut->get_report().failed_step;
    };

    MachineOptions options = make_options();
    options.priority = MachineOptions::kPriorityMin;
    EXPECT_EQ(run(options), MachineStep::kCrashHandlers);
    options.priority = MachineOptions::kPriorityMax;
    EXPECT_EQ(run(options), MachineStep::kCrashHandlers);
    options = make_options();
    options.window_stack = kThreadStackMin;
    options.runner_stack = kThreadStackMin;
    options.watch.lateness = Duration{0};
    options.recorder = path.c_str();
    options.recorder_capacity = 1U;
    EXPECT_EQ(run(options), MachineStep::kCrashHandlers);
    options = make_options();
    options.watchdog_timeout = 29_ms + Duration{2};
    EXPECT_EQ(run(options), MachineStep::kCrashHandlers);
    options.lead = Duration{1};
    options.watch = {Duration{0}, Duration{1}, {Duration{1}, 1}};
    EXPECT_EQ(run(options), MachineStep::kCrashHandlers);
    static_cast<void>(std::remove(path.c_str()));
}

Idle g_unstarted;
constexpr auto kUnstarted = system(frame(10_ms), window("idle", 2_ms, 4_ms, budget(4_ms), run(g_unstarted)));
Idle g_stopped;
constexpr auto kStopped = system(frame(10_ms), window("idle", 2_ms, 4_ms, budget(4_ms), run(g_stopped)));
Idle g_first;
Idle g_second;
constexpr auto kTwoCores = system(frame(10_ms), window("first", 2_ms, 4_ms, budget(4_ms), run(g_first)),
                                  window("second", 2_ms, 4_ms, core(1U), budget(4_ms), run(g_second)));

TEST(MachineOptionsTest, EachCoreOrNoneHasAProcessor) {
    verifies("SWR-PRT-070", Technique::kBoundaryValues, Polarity::kViolation);
    CrashHandlers taken;  // ends each run after the check of its options
    ASSERT_EQ(taken.install({[](void*) noexcept {}, nullptr, {}, 0U, FrameClock::at_epoch(0)}), Status::kOk);
    static constexpr std::array<int, 2U> kProcessors{0, 0};
    const auto run = [](std::size_t count) {
        MachineOptions options = make_options();
        options.processors = {kProcessors.data(), count};
        const auto sut = std::make_unique<Machine<kTwoCores>>(options);
        EXPECT_NE(sut->run(1U), Status::kOk);
        return sut->get_report().failed_step;
    };

    EXPECT_EQ(run(0U), MachineStep::kCrashHandlers);
    EXPECT_EQ(run(1U), MachineStep::kOptions);
    EXPECT_EQ(run(2U), MachineStep::kCrashHandlers);
}

TEST(MachineOptionsTest, DefaultsAreThoseOfTheManual) {
    verifies("SWR-PRT-070", Technique::kInterface, Polarity::kNominal);
    const MachineOptions options;
    EXPECT_EQ(options.outputs.close, nullptr);
    EXPECT_EQ(options.priority, 80);
    EXPECT_TRUE(options.processors.empty());
    EXPECT_EQ(options.window_stack, 262'144U);
    EXPECT_EQ(options.runner_stack, 1'048'576U);
    EXPECT_EQ(options.lead, 50_ms);
    EXPECT_EQ(options.watch.lateness, 100_ms);
    EXPECT_EQ(options.watch.period, 10_ms);
    EXPECT_EQ(options.watch.rate.span, 1_s);
    EXPECT_EQ(options.watch.rate.limit_ppm, 5000);
    EXPECT_EQ(options.watchdog_timeout, 1_s);
    EXPECT_EQ(options.recorder_capacity, 1024U);
    EXPECT_EQ(options.device, nullptr);
    EXPECT_EQ(options.recorder, nullptr);
    EXPECT_EQ(options.event_log, nullptr);
    EXPECT_EQ(MachineOptions::kPriorityStep, 5);
    EXPECT_EQ(MachineOptions::kBackgroundPriorityMin, 16);
    EXPECT_EQ(kThreadStackMin, 32'768U);
    EXPECT_EQ(kThreadStackGuard, 65'536U);
}

TEST(MachineOptionsTest, PrioritiesLeaveRoomForTheDistancesOfTheManual) {
    verifies("SWR-PRT-070", Technique::kBoundaryValues, Polarity::kNominal);
    EXPECT_EQ(MachineOptions::kPriorityMin, 1 + 5) << "windows are 5 below";
    EXPECT_EQ(MachineOptions::kPriorityMax, 99 - 10) << "the watchdog is 10 above";
}

TEST(MachineOptionsTest, RunThatIsStoppedBeforeItsFirstFrameMeasuresNothing) {
    verifies("SWR-PRT-070", Technique::kStateTransition, Polarity::kNominal);
    static Machine<kStopped> sut{make_options()};
    sut.request_stop();

    ASSERT_EQ(sut.run(5U), Status::kOk);
    EXPECT_EQ(sut.get_report().openings.opened, 0U);
    EXPECT_EQ(sut.get_report().longest_sample, Duration{0});
    EXPECT_EQ(sut.get_report().longest_apply, Duration{0});
    EXPECT_TRUE(sut.get_report().processor.is_granted);
    EXPECT_EQ(sut.get_report().processor.system_error, 0);
}

TEST(MachineOptionsTest, RecorderFileThatCannotBeOpenedEndsTheRunBeforeItsStart) {
    verifies("SWR-PRT-070", Technique::kFaultInjection, Polarity::kViolation);
    MachineOptions options = make_options();
    options.recorder = "/nowhere/run.rec";
    static Machine<kRefused> sut{options};
    g_closed = 0;

    EXPECT_EQ(sut.run(1U), Status::kError);
    EXPECT_EQ(sut.get_report().failed_step, MachineStep::kRecorder);
    EXPECT_EQ(sut.get_report().file_error, MappedFileError::kCannotOpen);
    EXPECT_EQ(g_closed, 0);
}

TEST(MachineOptionsTest, EventLogOfAnotherRecorderEndsTheRunAndReleasesTheFile) {
    verifies("SWR-PRT-070", Technique::kFaultInjection, Polarity::kViolation);
    std::vector<std::byte> region(4096U);
    FlightRecorder other;
    ASSERT_EQ(other.open({region.data(), region.size()}), Status::kOk);
    std::array<Event, 4U> storage{};
    EventLog log{storage};
    ASSERT_EQ(log.attach(other), Status::kOk);
    const std::string path = ::testing::TempDir() + "mamori_options_" + std::to_string(::getpid());
    MachineOptions options = make_options();
    options.recorder = path.c_str();
    options.recorder_capacity = 4U;
    options.event_log = &log;
    const auto sut = std::make_unique<Machine<kRefused>>(options);

    for (int i = 0; i < 2; ++i) {
        EXPECT_EQ(sut->run(1U), Status::kPreconditionNotMet);
        EXPECT_EQ(sut->get_report().failed_step, MachineStep::kRecorder);
    }
    MappedFile file;
    EXPECT_EQ(file.open(path.c_str(), calc_recorder_file_size(4U)), Status::kOk);
    static_cast<void>(std::remove(path.c_str()));
}

TEST(MachineOptionsTest, RunnerThatCannotBeStartedEndsTheRunWithClosedOutputs) {
    verifies("SWR-PRT-070", Technique::kFaultInjection, Polarity::kViolation);
    MachineOptions options = make_options();
    options.runner_stack = std::size_t{1U} << 60U;  // larger than the address space
    const auto sut = std::make_unique<Machine<kUnstarted>>(options);
    g_closed = 0;

    EXPECT_NE(sut->run(1U), Status::kOk);
    EXPECT_EQ(sut->get_report().failed_step, MachineStep::kRunnerThreads);
    EXPECT_EQ(sut->get_report().openings.opened, 0U);
    EXPECT_EQ(g_closed, 1);
}

TEST(MachineOptionsTest, EachStepHasASentence) {
    verifies("SWR-PRT-070", Technique::kInterface, Polarity::kNominal);
    std::vector<std::string> sentences;
    for (int step = 0; step <= static_cast<int>(MachineStep::kStop); ++step) {
        sentences.emplace_back(describe(static_cast<MachineStep>(step)));
        EXPECT_FALSE(sentences.back().empty()) << step;
        for (std::size_t i = 0U; i + 1U < sentences.size(); ++i) {
            EXPECT_NE(sentences[i], sentences.back());
        }
    }
    EXPECT_STREQ(describe(static_cast<MachineStep>(200)), "unknown step");
}

}  // namespace
}  // namespace mamori::ports::posix_rt
