// SPDX-License-Identifier: Apache-2.0
// Goal: virtual time keeps the contracts of a port. Method: the rules of ports/conformance in their order, in
// random orders, and in every order up to a depth. Since time is simulated the rules demand exact instants.
// The counts are pinned: fewer would mean that something is no longer tried.
#include <gtest/gtest.h>

#include <array>
#include <iostream>

#include "mamori/ports/conformance/clock_contract.hpp"
#include "mamori/ports/conformance/host_contract.hpp"
#include "mamori/ports/conformance/rule_runner.hpp"
#include "mamori/ports/conformance/timer_contract.hpp"
#include "mamori/ports/conformance/watchdog_contract.hpp"
#include "mamori/ports/virtual_time/frame_runner.hpp"
#include "mamori/ports/virtual_time/virtual_host.hpp"
#include "mamori/ports/virtual_time/virtual_watchdog.hpp"
#include "mamori/trace/verifies.hpp"

namespace mamori::ports::virtual_time {
namespace {

using conformance::explore;
using conformance::Report;
using conformance::run_in_order;
using conformance::run_randomly;
using conformance::TrialFactory;
using namespace verification;

constexpr std::uint64_t kSeed = 20261122U;

class VirtualHostRig final : public conformance::HostRig {
  public:
    Instant get_now() const override { return host_.get_now(); }
    void wait_until(Instant instant) override {
        if (instant > host_.get_now()) {
            host_.advance_to(instant);
        }
    }
    Duration get_tick() const override { return 1_ms; }
    bool is_exact() const override { return true; }
    WindowHost& get_host() override { return host_; }
    void plan(const WindowHost::Work& work, const std::vector<conformance::StepPlan>& steps) override {
        for (std::size_t i = 0U; i < steps.size(); ++i) {
            ASSERT_EQ(host_.set_duration(work.component + i, steps[i].is_hang ? kNever : steps[i].time),
                      Status::kOk);
        }
    }
    void spend(std::size_t, const conformance::StepPlan&) noexcept override {}
    void release(std::size_t) noexcept override {}

  private:
    std::array<Duration, kComponentCount> durations_{};
    IndexedVirtualHost host_{durations_};
};

class VirtualWatchdogRig final : public conformance::WatchdogRig {
  public:
    safety::Watchdog& get_watchdog() override { return watchdog_; }
    Duration get_timeout() const override { return 10_ms; }
    Instant get_now() const override { return now_; }
    void let_pass(Duration time) override { now_ = now_ + time; }
    bool has_expired() override {
        watchdog_.check(now_);
        return watchdog_.has_expired();
    }

  private:
    Instant now_{};
    VirtualWatchdog watchdog_{10_ms};
};

class FrameRunnerRig final : public conformance::TimerRig {
  public:
    explicit FrameRunnerRig(Executive& executive) : cores_{SimulatedCore{executive, host_}} {}

    void run(std::uint64_t frame_count) override {
        for (std::uint64_t i = 0U; i < frame_count; ++i) {
            runner_.run_frame();
        }
    }
    Counts get_counts() const override { return {0U, runner_.get_overrun_count()}; }
    WindowHost& get_host() override { return host_; }
    void wait_until(Instant) override {}  // no work is ever out
    bool is_exact() const override { return true; }
    void plan(std::size_t component, Duration time) override {
        ASSERT_EQ(host_.set_duration(component, time), Status::kOk);
    }
    void spend(Duration) noexcept override {}

  private:
    std::array<Duration, kWindowCount> durations_{};
    IndexedVirtualHost host_{durations_};
    NoDevices devices_;
    std::array<SimulatedCore, 1U> cores_;
    FrameRunner runner_{cores_, devices_};
};

TrialFactory make_clock() {
    return conformance::make_clock_trials([] { return std::make_unique<VirtualHostRig>(); });
}
TrialFactory make_host() {
    return conformance::make_host_trials([] { return std::make_unique<VirtualHostRig>(); });
}
TrialFactory make_timer() {
    return conformance::make_timer_trials(
        [](Executive& executive) { return std::make_unique<FrameRunnerRig>(executive); });
}
TrialFactory make_watchdog() {
    return conformance::make_watchdog_trials([] { return std::make_unique<VirtualWatchdogRig>(); });
}

/// Ten walks of 20,000 steps.
void walk(const TrialFactory& factory) {
    for (std::uint64_t seed = kSeed; seed < kSeed + 10U; ++seed) {
        const Report report = run_randomly(factory, seed, 20'000U);
        EXPECT_TRUE(report.is_kept()) << report.to_text();
    }
}

void expect_all_tried(const Report& report, const char* counts) {
    std::cout << report.to_text();
    EXPECT_EQ(report.to_text(), counts);
}

TEST(VirtualTimeConformanceTest, ClockKeepsItsContract) {
    verifies("SWR-CNF-001", Technique::kStateTransition);
    EXPECT_EQ(run_in_order(make_clock()).to_text(), "6 rules, 1 sequences, 6 steps, 3 states\n");
    walk(make_clock());
}

TEST(VirtualTimeConformanceTest, ClockKeepsItsContractInEveryOrder) {
    verifies("SWR-CNF-010", Technique::kStateTransition);
    expect_all_tried(explore(make_clock(), 6U), "6 rules, 46656 sequences, 279936 steps, 18 states\n");
}

TEST(VirtualTimeConformanceTest, StepsRunOnceAndInOrder) {
    verifies("SWR-CNF-002", Technique::kStateTransition);
    EXPECT_EQ(run_in_order(make_host()).to_text(), "28 rules, 1 sequences, 43 steps, 10 states\n");
}

TEST(VirtualTimeConformanceTest, OnlyStepsThatEndByTheDeadlineAreCounted) {
    verifies("SWR-CNF-003", Technique::kStateTransition);
    walk(make_host());
}

TEST(VirtualTimeConformanceTest, HostKeepsItsContractInEveryOrder) {
    verifies("SWR-CNF-010", Technique::kStateTransition);
    expect_all_tried(explore(make_host(), 4U), "28 rules, 197152 sequences, 788608 steps, 36 states\n");
}

TEST(VirtualTimeConformanceTest, WindowsThatHangKeepTheContractInEveryLongOrder) {
    verifies("SWR-CNF-010", Technique::kStateTransition);
    const TrialFactory hangs = conformance::select_rules(
        make_host(),
        {"work that fits, window 0", "work that fits, window 1", "a late step, window 1",
         "a hang of the second step, window 1", "query during the hang, window 1", "release, window 1",
         "a hang of the first step, window 2", "release, window 2", "time passes"});
    expect_all_tried(explore(hangs, 7U), "9 rules, 219018 sequences, 1533126 steps, 24 states\n");
}

TEST(VirtualTimeConformanceTest, TimerKeepsItsContract) {
    verifies("SWR-CNF-011", Technique::kStateTransition);
    EXPECT_TRUE(run_in_order(make_timer()).is_kept());
    walk(make_timer());
}

TEST(VirtualTimeConformanceTest, TimerKeepsItsContractInEveryOrder) {
    verifies("SWR-CNF-010", Technique::kStateTransition);
    expect_all_tried(explore(make_timer(), 8U), "6 rules, 6561 sequences, 52488 steps, 4 states\n");
}

TEST(VirtualTimeConformanceTest, WatchdogKeepsItsContract) {
    verifies("SWR-CNF-006", Technique::kStateTransition);
    EXPECT_EQ(run_in_order(make_watchdog()).to_text(), "10 rules, 1 sequences, 12 steps, 4 states\n");
    walk(make_watchdog());
}

TEST(VirtualTimeConformanceTest, WatchdogKeepsItsContractInEveryOrder) {
    verifies("SWR-CNF-010", Technique::kStateTransition);
    expect_all_tried(explore(make_watchdog(), 8U), "10 rules, 17172 sequences, 137376 steps, 7 states\n");
}

}  // namespace
}  // namespace mamori::ports::virtual_time
