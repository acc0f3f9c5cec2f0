// SPDX-License-Identifier: Apache-2.0
// Goal: the real-time port complies with the contracts of a port. Method: the rules of ports/conformance in
// the fixed order and in random order, in real time; the rules of the storage also in every order up to a
// length. The tests do not depend on the speed of the host: the rules require order, counts and lower bounds
// only. A process that kills itself simulates a crash.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <csignal>
#include <filesystem>
#include <iostream>
#include <string>
#include <thread>

#include "mamori/ports/conformance/clock_contract.hpp"
#include "mamori/ports/conformance/host_contract.hpp"
#include "mamori/ports/conformance/rule_runner.hpp"
#include "mamori/ports/conformance/storage_contract.hpp"
#include "mamori/ports/conformance/timer_contract.hpp"
#include "mamori/ports/conformance/watchdog_contract.hpp"
#include "mamori/ports/posix_rt/core_runner.hpp"
#include "mamori/ports/posix_rt/frame_clock.hpp"
#include "mamori/ports/posix_rt/guarded_host.hpp"
#include "mamori/ports/posix_rt/mapped_file.hpp"
#include "mamori/ports/posix_rt/software_watchdog.hpp"
#include "mamori/trace/verifies.hpp"

namespace mamori::ports::posix_rt {
namespace {

using conformance::explore;
using conformance::Report;
using conformance::run_in_order;
using conformance::run_randomly;
using conformance::TrialFactory;
using namespace verification;

constexpr std::uint64_t kSeed = 20261122U;

class FrameClockRig final : public conformance::ClockRig {
  public:
    Instant get_now() const override { return clock_.get_now(); }
    void wait_until(Instant instant) override { clock_.wait_until(instant); }
    Duration get_tick() const override { return 1_ms; }
    bool is_exact() const override { return false; }

  private:
    const FrameClock clock_ = FrameClock::starting_in(0_ms);
};

class GuardedHostRig final : public conformance::HostRig {
  public:
    GuardedHostRig() { EXPECT_EQ(host_.open(), Status::kOk); }
    ~GuardedHostRig() override {
        while (host_.close() != Status::kOk) {
            std::this_thread::yield();
        }
    }

    Instant get_now() const override { return clock_.get_now(); }
    void wait_until(Instant instant) override { clock_.wait_until(instant); }
    Duration get_tick() const override { return 1_ms; }
    bool is_exact() const override { return false; }
    WindowHost& get_host() override { return host_; }
    void plan(const WindowHost::Work& work, const std::vector<conformance::StepPlan>&) override {
        is_released_.at(work.window).store(false, std::memory_order_relaxed);
    }
    void spend(std::size_t window, const conformance::StepPlan& step) noexcept override {
        while (step.is_hang && !is_released_[window].load(std::memory_order_relaxed)) {
            std::this_thread::yield();
        }
        const Instant end = clock_.get_now() + step.time;
        while (clock_.get_now() < end) {
        }
    }
    void release(std::size_t window) noexcept override {
        is_released_[window].store(true, std::memory_order_relaxed);
    }

  private:
    const FrameClock clock_ = FrameClock::starting_in(0_ms);
    std::array<WindowThread, kWindowCount> threads_;
    std::array<std::atomic<bool>, kWindowCount> is_released_{};
    GuardedHost host_{threads_, clock_, {}};
};

class CoreRunnerRig final : public conformance::TimerRig {
  public:
    explicit CoreRunnerRig(Executive& executive) : runner_(executive, host_, clock_) {
        EXPECT_EQ(host_.open(), Status::kOk);
    }
    ~CoreRunnerRig() override {
        while (host_.close() != Status::kOk) {
            std::this_thread::yield();
        }
    }

    void run(std::uint64_t frame_count) override { runner_.run(frame_count); }
    Counts get_counts() const override { return {runner_.get_counts().missed, runner_.get_counts().overran}; }
    WindowHost& get_host() override { return host_; }
    void wait_until(Instant instant) override { clock_.wait_until(instant); }
    bool is_exact() const override { return false; }
    void plan(std::size_t, Duration) override {}
    void spend(Duration time) noexcept override {
        const Instant end = clock_.get_now() + time;
        while (clock_.get_now() < end) {
        }
    }

  private:
    const FrameClock clock_ = FrameClock::starting_in(0_ms);
    std::array<WindowThread, kWindowCount> threads_;
    GuardedHost host_{threads_, clock_, {}};
    CoreRunner runner_;
};

/// Uses a temporary file, which it deletes.
class MappedFileRig final : public conformance::StorageRig {
  public:
    ~MappedFileRig() override {
        file_.close();
        std::filesystem::remove(path_);
    }

    Status open(std::size_t size) override { return file_.open(path_.c_str(), size); }
    void close() override { file_.close(); }
    Span<std::byte> get_region() override { return file_.get_region(); }
    Status open_as_another(std::size_t size) override {
        MappedFile another;
        return another.open(path_.c_str(), size);
    }
    void crash(std::size_t size, const std::function<void(Span<std::byte>)>& write) override {
        const pid_t child = ::fork();
        if (child == 0) {
            MappedFile file;
            if (file.open(path_.c_str(), size) != Status::kOk) {
                ::_exit(1);
            }
            write(file.get_region());
            ::kill(::getpid(), SIGKILL);
        }
        int status = 0;
        EXPECT_EQ(::waitpid(child, &status, 0), child);
        EXPECT_TRUE(WIFSIGNALED(status)) << "the file could not be opened";
    }

  private:
    std::string path_ = ::testing::TempDir() + "conformance_" + std::to_string(::getpid());
    MappedFile file_;
};

/// has_expired() represents the relay. The watchdog thread then closes the outputs.
class SoftwareWatchdogRig final : public conformance::WatchdogRig {
  public:
    SoftwareWatchdogRig() { EXPECT_EQ(watchdog_.open({}), Status::kOk); }
    ~SoftwareWatchdogRig() override {
        EXPECT_EQ(watchdog_.close(), Status::kOk);
        EXPECT_EQ(is_closed_.load(), watchdog_.has_expired());
    }

    safety::Watchdog& get_watchdog() override { return watchdog_; }
    Duration get_timeout() const override { return kTimeout; }
    Instant get_now() const override { return clock_.get_now(); }
    void let_pass(Duration time) override { clock_.wait_until(clock_.get_now() + time); }
    bool has_expired() override { return watchdog_.has_expired(); }

  private:
    static constexpr Duration kTimeout = 1_ms;
    static void close(void* self) noexcept {
        static_cast<SoftwareWatchdogRig*>(self)->is_closed_.store(true);
    }

    const FrameClock clock_ = FrameClock::starting_in(0_ms);
    std::atomic<bool> is_closed_{false};
    SoftwareWatchdog watchdog_{clock_, {0_ms, kTimeout}, {&SoftwareWatchdogRig::close, this, false}};
};

TrialFactory make_clock() {
    return conformance::make_clock_trials([] { return std::make_unique<FrameClockRig>(); });
}
TrialFactory make_host() {
    return conformance::make_host_trials([] { return std::make_unique<GuardedHostRig>(); });
}
TrialFactory make_timer() {
    return conformance::make_timer_trials(
        [](Executive& executive) { return std::make_unique<CoreRunnerRig>(executive); });
}
TrialFactory make_storage() {
    return conformance::make_storage_trials([] { return std::make_unique<MappedFileRig>(); });
}

TrialFactory make_watchdog() {
    return conformance::make_watchdog_trials([] { return std::make_unique<SoftwareWatchdogRig>(); });
}

void expect_kept(const Report& report) {
    EXPECT_TRUE(report.is_kept()) << report.to_text();
    std::cout << report.to_text();
}

TEST(PosixRtConformanceTest, ClockKeepsItsContract) {
    verifies("SWR-CNF-001", Technique::kStateTransition);
    expect_kept(run_in_order(make_clock()));
    expect_kept(run_randomly(make_clock(), kSeed, 300U));
}

TEST(PosixRtConformanceTest, StepsRunOnceAndInOrder) {
    verifies("SWR-CNF-002", Technique::kStateTransition);
    expect_kept(run_in_order(make_host()));
}

TEST(PosixRtConformanceTest, OnlyStepsThatEndByTheDeadlineAreCounted) {
    verifies("SWR-CNF-003", Technique::kStateTransition);
    expect_kept(run_randomly(make_host(), kSeed, 400U));
}

TEST(PosixRtConformanceTest, WorkThatHangsIsAbortedAndDoesNotDelayOtherWindows) {
    verifies("SWR-CNF-004", Technique::kStateTransition);
    expect_kept(run_randomly(make_host(), kSeed + 1U, 400U));
}

TEST(PosixRtConformanceTest, AbortedWorkIsReportedAsReturnedOnlyAfterItsEnd) {
    verifies("SWR-CNF-005", Technique::kStateTransition);
    expect_kept(run_randomly(make_host(), kSeed + 2U, 400U));
}

TEST(PosixRtConformanceTest, TimerKeepsItsContract) {
    verifies("SWR-CNF-011", Technique::kStateTransition);
    expect_kept(run_in_order(make_timer()));
    expect_kept(run_randomly(make_timer(), kSeed, 40U));
}

TEST(PosixRtConformanceTest, WatchdogKeepsItsContract) {
    verifies("SWR-CNF-006", Technique::kStateTransition);
    expect_kept(run_in_order(make_watchdog()));
    expect_kept(run_randomly(make_watchdog(), kSeed, 1000U));
}

TEST(PosixRtConformanceTest, StorageKeepsItsContract) {
    verifies("SWR-CNF-007", Technique::kStateTransition);
    expect_kept(run_in_order(make_storage()));
    expect_kept(run_randomly(make_storage(), kSeed, 1000U));
}

TEST(PosixRtConformanceTest, StorageKeepsItsContractInEveryOrder) {
    verifies("SWR-CNF-010", Technique::kStateTransition);
    const Report report = explore(make_storage(), 3U);
    expect_kept(report);
    EXPECT_EQ(report.to_text(), "12 rules, 108 sequences, 324 steps, 9 states\n");
}

}  // namespace
}  // namespace mamori::ports::posix_rt
