// SPDX-License-Identifier: Apache-2.0
// Goal: report and recorder of a machine tell what happened, when on its time line, and why the run ended.
// Method: runs that end for each cause; the file of the recorder is read back.
#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <memory>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "mamori/kernel/system/system.hpp"
#include "mamori/ports/posix_rt/machine.hpp"
#include "mamori/trace/verifies.hpp"
#include "support/machine_records.hpp"
#include "support/patient_options.hpp"
#include "support/threads.hpp"

namespace mamori::ports::posix_rt {
namespace {

using namespace verification;
using literals::operator""_ms;
using literals::operator""_s;

class Faulty final : public Component {
  public:
    constexpr Faulty() noexcept : Component("faulty") {}
    Status starts{Status::kOk};
    std::atomic<bool> is_to_crash{false};
    std::chrono::milliseconds start_time{0};

    Status on_activated(ContextHandle) noexcept override {
        std::this_thread::sleep_for(start_time);
        return starts;
    }
    Status on_execute(ContextHandle) noexcept override {
        if (is_to_crash) {
            std::raise(SIGSEGV);
        }
        return Status::kOk;
    }
};

#define MAMORI_TEST_SYSTEM(name) \
    Faulty g_faulty_##name;      \
    constexpr auto name = system(frame(10_ms), window("work", 2_ms, 4_ms, budget(4_ms), run(g_faulty_##name)))

MAMORI_TEST_SYSTEM(kUnused);
MAMORI_TEST_SYSTEM(kSignalled);
MAMORI_TEST_SYSTEM(kLateSignal);
MAMORI_TEST_SYSTEM(kRequested);
MAMORI_TEST_SYSTEM(kFails);
MAMORI_TEST_SYSTEM(kStartsSlowly);
MAMORI_TEST_SYSTEM(kFound);
MAMORI_TEST_SYSTEM(kCrashes);

/// An owner of the signal, so that its end of the run does not end this program.
class OwnHandler final {
  public:
    explicit OwnHandler(int signal) : signal_(signal) {
        struct sigaction own{};
        own.sa_handler = [](int) {};
        EXPECT_EQ(::sigaction(signal_, &own, &before_), 0);
    }
    OwnHandler(const OwnHandler&) = delete;
    OwnHandler& operator=(const OwnHandler&) = delete;
    ~OwnHandler() { static_cast<void>(::sigaction(signal_, &before_, nullptr)); }

  private:
    int signal_;
    struct sigaction before_{};
};

class MachineRecordTest : public ::testing::Test {
  protected:
    MachineRecordTest() {
        static_cast<void>(std::remove(path_.c_str()));
        g_closed = 0;
    }
    ~MachineRecordTest() override { static_cast<void>(std::remove(path_.c_str())); }
    MachineOptions make_recorded() const {
        MachineOptions options = make_options();
        options.recorder = path_.c_str();
        options.recorder_capacity = 16U;
        return options;
    }
    /// The only record of `event`.
    FlightRecord find(MachineEvent event) const {
        std::vector<FlightRecord> found;
        for (const FlightRecord& record : read_machine_records(path_)) {
            if (record.code == static_cast<std::uint16_t>(event)) {
                found.push_back(record);
            }
        }
        EXPECT_EQ(found.size(), 1U) << static_cast<int>(event);
        return found.empty() ? FlightRecord{} : found.front();
    }

    const std::string path_ = ::testing::TempDir() + "machine_record_" + std::to_string(::getpid());
};

TEST_F(MachineRecordTest, CodesAreThoseOfTheManual) {
    verifies("SWR-PRT-070", Technique::kInterface, Polarity::kNominal);
    EXPECT_EQ(kMachineSource, 65535U);
    EXPECT_EQ(static_cast<int>(MachineEvent::kStarted), 1);
    EXPECT_EQ(static_cast<int>(MachineEvent::kStopRequested), 2);
    EXPECT_EQ(static_cast<int>(MachineEvent::kOutputsClosed), 3);
    EXPECT_EQ(static_cast<int>(MachineEvent::kWatchFinding), 4);
    EXPECT_EQ(static_cast<int>(MachineEvent::kStopped), 5);
    EXPECT_EQ(static_cast<int>(MachineEvent::kActionOverrun), 6);
}

TEST_F(MachineRecordTest, ReportBeforeTheFirstRunStatesNothing) {
    verifies("SWR-PRT-070", Technique::kStateTransition, Polarity::kNominal);
    const auto sut = std::make_unique<Machine<kUnused>>();
    const MachineReport& report = sut->get_report();
    EXPECT_EQ(report.failed_step, MachineStep::kNone);
    EXPECT_EQ(report.file_error, MappedFileError::kNone);
    EXPECT_EQ(report.late_component, nullptr);
    EXPECT_EQ(report.signal, 0);
    EXPECT_EQ(report.signalled, Instant{0});
    EXPECT_EQ(report.until_closed, Duration{0});
    EXPECT_EQ(report.finding.fault, GridFault::kNone);
    for (const OpeningCounts& counts : {report.openings, report.background}) {
        EXPECT_EQ(counts.opened, 0U);
        EXPECT_EQ(counts.overran, 0U);
        EXPECT_EQ(counts.missed, 0U);
        EXPECT_EQ(counts.worst_lateness, Duration{0});
    }
    EXPECT_EQ(report.longest_sample, Duration{0});
    EXPECT_EQ(report.longest_apply, Duration{0});
    for (const Right& right : {report.memory, report.priority, report.processor}) {
        EXPECT_FALSE(right.is_granted);
        EXPECT_EQ(right.system_error, 0);
    }
}

TEST_F(MachineRecordTest, SignalIsReportedAtItsInstant) {
    verifies("SWR-PRT-072", Technique::kRequirementsBased, Polarity::kNominal);
    static Machine<kSignalled> sut{make_recorded()};
    const OwnHandler own{SIGINT};
    Instant before{};
    Instant after{};

    ASSERT_EQ(sut.run(5U,
                      [&](std::uint64_t frame) {
                          if (frame == 1U) {
                              before = sut.get_clock().get_now();
                              static_cast<void>(::raise(SIGINT));
                              after = sut.get_clock().get_now();
                          }
                      }),
              Status::kOk);

    const MachineReport& report = sut.get_report();
    EXPECT_EQ(report.signal, SIGINT);
    EXPECT_GE(report.signalled, before);
    EXPECT_LE(report.signalled, after);
    EXPECT_GT(report.until_closed, Duration{0});
    EXPECT_LE(report.until_closed, after - before);
    EXPECT_EQ(find(MachineEvent::kStarted).argument, 1) << "cores";
    EXPECT_LT(find(MachineEvent::kStarted).time, before);
    EXPECT_EQ(find(MachineEvent::kStopRequested).argument, SIGINT);
    EXPECT_EQ(find(MachineEvent::kStopRequested).time, report.signalled);
    EXPECT_EQ(find(MachineEvent::kOutputsClosed).argument, report.until_closed.ns);
    EXPECT_EQ(find(MachineEvent::kOutputsClosed).time, report.signalled + report.until_closed);
    EXPECT_EQ(find(MachineEvent::kStopped).argument, static_cast<std::int64_t>(Status::kOk));
    EXPECT_EQ(find(MachineEvent::kStopped).severity, Severity::kInfo);
    EXPECT_GE(find(MachineEvent::kStopped).time, after);

    const std::uint64_t opened = report.openings.opened;
    ASSERT_EQ(sut.run(1U), Status::kOk);
    EXPECT_EQ(sut.get_report().openings.opened, opened + 1U) << "the stop has ended";
    EXPECT_EQ(sut.get_report().signal, 0) << "of the last run only";
    EXPECT_EQ(sut.get_report().until_closed, Duration{0});
    EXPECT_EQ(g_closed, 2);
}

TEST_F(MachineRecordTest, SignalAfterTheOutputsWereClosedTookNoTime) {
    verifies("SWR-PRT-072", Technique::kErrorGuessing, Polarity::kViolation);
    MachineOptions options = make_recorded();
    options.watch.lateness = Duration{0};
    static Machine<kLateSignal> sut{options};
    const OwnHandler own{SIGTERM};

    EXPECT_EQ(sut.run(MachineRun::kAllFrames,
                      [](std::uint64_t) {
                          while (g_closed == 0) {  // by the watch
                              std::this_thread::yield();
                          }
                          std::this_thread::sleep_for(std::chrono::milliseconds{1});
                          static_cast<void>(::raise(SIGTERM));
                      }),
              Status::kError);

    EXPECT_EQ(sut.get_report().signal, SIGTERM);
    EXPECT_EQ(sut.get_report().until_closed, Duration{0});
    EXPECT_LT(find(MachineEvent::kOutputsClosed).time, sut.get_report().signalled);
    EXPECT_EQ(find(MachineEvent::kOutputsClosed).argument, 0);
}

TEST_F(MachineRecordTest, RequestedStopIsRecordedWithoutASignal) {
    verifies("SWR-PRT-070", Technique::kEquivalenceClasses, Polarity::kNominal);
    static Machine<kRequested> sut{make_recorded()};
    Instant requested{};

    ASSERT_EQ(sut.run(MachineRun::kAllFrames,
                      [&requested](std::uint64_t) {
                          requested = sut.get_clock().get_now();
                          sut.request_stop();
                      }),
              Status::kOk);

    const FlightRecord record = find(MachineEvent::kStopRequested);
    EXPECT_EQ(record.argument, 0);
    EXPECT_EQ(record.severity, Severity::kInfo);
    EXPECT_GE(record.time, requested);
    EXPECT_LT(record.time, requested + 3600_s);
    EXPECT_EQ(find(MachineEvent::kOutputsClosed).argument, 0);
    EXPECT_GE(find(MachineEvent::kOutputsClosed).time, requested);
}

TEST_F(MachineRecordTest, FailedStartIsRecordedBeforeTheTimeLine) {
    verifies("SWR-PRT-070", Technique::kFaultInjection, Polarity::kViolation);
    MachineOptions options = make_recorded();
    options.lead = 3600_s;
    options.watchdog_timeout = 7200_s;
    static Machine<kFails> sut{options};
    g_faulty_kFails.starts = Status::kUnsupported;

    const std::set<pid_t> threads = find_threads();
    EXPECT_EQ(sut.run(1U), Status::kUnsupported);
    EXPECT_EQ(find_threads(), threads) << "none is left";

    const FlightRecord record = find(MachineEvent::kStopped);
    EXPECT_EQ(record.argument, static_cast<std::int64_t>(Status::kUnsupported));
    EXPECT_EQ(record.severity, Severity::kFault);
    EXPECT_GE(record.time, Instant{0} - 3600_s);
    EXPECT_LT(record.time, Instant{0}) << "its first frame would have begun in an hour";
    EXPECT_EQ(read_machine_records(path_).size(), 1U);
    EXPECT_EQ(g_closed, 1);
}

TEST_F(MachineRecordTest, TimeLineBeginsAfterTheStartHoweverLongItTakes) {
    verifies("SWR-PRT-070", Technique::kBoundaryValues, Polarity::kNominal);
    MachineOptions options = make_recorded();
    options.lead = 200_ms;
    g_faulty_kStartsSlowly.start_time = std::chrono::milliseconds{300};
    Instant started{1};
    for (int i = 0; i < 5 && started >= Instant{0}; ++i) {  // again if the host stalled for longer
        static_cast<void>(std::remove(path_.c_str()));
        const auto sut = std::make_unique<Machine<kStartsSlowly>>(options);
        ASSERT_EQ(sut->run(1U), Status::kOk);
        started = find(MachineEvent::kStarted).time;
    }
    EXPECT_LT(started, Instant{0});
    EXPECT_GE(started, Instant{0} - 200_ms);
}

TEST_F(MachineRecordTest, FindingOfTheWatchIsRecordedWithItsFault) {
    verifies("SWR-PRT-073", Technique::kFaultInjection, Polarity::kViolation);
    MachineOptions options = make_recorded();
    options.watch.lateness = Duration{0};
    static Machine<kFound> sut{options};

    EXPECT_EQ(sut.run(MachineRun::kAllFrames,
                      [](std::uint64_t) {
                          while (g_closed == 0) {
                              std::this_thread::yield();
                          }
                      }),
              Status::kError);

    const FlightRecord record = find(MachineEvent::kWatchFinding);
    EXPECT_EQ(record.argument, static_cast<std::int64_t>(GridFault::kOverdue));
    EXPECT_EQ(record.severity, Severity::kFault);
    EXPECT_EQ(record.time, sut.get_report().finding.seen);
    EXPECT_EQ(find(MachineEvent::kStopped).argument, static_cast<std::int64_t>(Status::kError));
    EXPECT_EQ(find(MachineEvent::kStopped).severity, Severity::kFault);
    EXPECT_EQ(sut.get_report().signal, 0);
}

TEST_F(MachineRecordTest, CrashIsNotedOnTheTimeLineWithItsSession) {
    verifies("SWR-PRT-073", Technique::kFaultInjection, Polarity::kViolation);
    static Machine<kCrashes> sut{make_recorded()};

    EXPECT_EXIT(
        {
            static_cast<void>(sut.run(1U));
            g_faulty_kCrashes.is_to_crash = true;
            static_cast<void>(sut.run());
        },
        testing::KilledBySignal(SIGSEGV), "^$");

    const std::vector<std::byte> bytes = read_recorder_file(path_);
    CrashNote note;
    ASSERT_EQ(read_crash_note({bytes.data(), bytes.size()}, note), CrashNoteState::kWhole);
    EXPECT_EQ(note.signal, SIGSEGV);
    EXPECT_EQ(note.session, 1U);
    EXPECT_EQ(note.place.window, 0U);
    EXPECT_EQ(note.place.component, 0U);
    EXPECT_GT(note.time, find(MachineEvent::kStopped).time);
    EXPECT_LT(note.time, Instant{0} + 3600_s);
}

}  // namespace
}  // namespace mamori::ports::posix_rt
