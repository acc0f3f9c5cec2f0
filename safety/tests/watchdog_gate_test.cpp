// SPDX-License-Identifier: Apache-2.0
// Goal: the watchdog is serviced on proven health, inside its window, and never again after a missed window.
// Method: all combinations of health; both sides of both ends of the window; a device that refuses.
#include "mamori/safety/supervision/watchdog_gate.hpp"

#include "mamori/trace/verifies.hpp"
#include "mamori/verification/failed_check.hpp"

namespace mamori::safety {
namespace {

using namespace verification;

class FakeWatchdog final : public Watchdog {
  public:
    Status service(Instant) noexcept override {
        ++services;
        return answer;
    }
    int services{0};
    Status answer{Status::kOk};
};

class WatchdogGateTest : public ::testing::Test {
  protected:
    WatchdogOutcome step(std::int64_t at_ns, GlobalStatus status = GlobalStatus::kOk,
                         bool is_consistent = true) {
        return sut_.step(Instant{at_ns}, status, is_consistent);
    }

    FakeWatchdog watchdog_{};
    WatchdogGate sut_{watchdog_, {Duration{100}, Duration{200}}};
};

TEST_F(WatchdogGateTest, MayBeServicedOnlyWhenEverythingIsProven) {
    verifies("SWR-WDG-001", Technique::kEquivalenceClasses, Polarity::kViolation);

    EXPECT_TRUE(may_service_watchdog(GlobalStatus::kOk, true));
    EXPECT_FALSE(may_service_watchdog(GlobalStatus::kFailed, true));
    EXPECT_FALSE(may_service_watchdog(GlobalStatus::kExpired, true));
    EXPECT_FALSE(may_service_watchdog(GlobalStatus::kOk, false));
    EXPECT_FALSE(may_service_watchdog(GlobalStatus::kFailed, false));
    EXPECT_FALSE(may_service_watchdog(GlobalStatus::kExpired, false));
    EXPECT_FALSE(may_service_watchdog(static_cast<GlobalStatus>(77), true))
        << "a corrupted status proves nothing";
}

TEST_F(WatchdogGateTest, HealthyCyclesAreServicedAndCounted) {
    verifies("SWR-WDG-001");

    for (std::int64_t at = 0; at < 1000; at += 100) {
        ASSERT_EQ(step(at), WatchdogOutcome::kServiced);
    }
    EXPECT_EQ(watchdog_.services, 10);
    EXPECT_EQ(sut_.get_service_count(), 10U);
    EXPECT_EQ(sut_.get_refusal_count(), 0U);
}

TEST_F(WatchdogGateTest, UnprovenHealthIsNeverServiced) {
    verifies("SWR-WDG-001", Technique::kFaultInjection, Polarity::kViolation);

    EXPECT_EQ(step(0, GlobalStatus::kFailed), WatchdogOutcome::kRefused);
    EXPECT_EQ(step(100, GlobalStatus::kExpired), WatchdogOutcome::kRefused);
    EXPECT_EQ(step(200, GlobalStatus::kOk, false), WatchdogOutcome::kRefused);
    EXPECT_EQ(watchdog_.services, 0);
    EXPECT_EQ(sut_.get_refusal_count(), 3U);
}

TEST_F(WatchdogGateTest, ShortFailureInsideTheWindowIsSurvived) {
    verifies("SWR-WDG-001", Technique::kStateTransition);
    ASSERT_EQ(step(0), WatchdogOutcome::kServiced);

    EXPECT_EQ(step(100, GlobalStatus::kFailed), WatchdogOutcome::kRefused);
    EXPECT_EQ(step(200), WatchdogOutcome::kServiced);
}

TEST_F(WatchdogGateTest, ServicesAtBothEndsOfTheWindow) {
    verifies("SWR-WDG-002", Technique::kBoundaryValues);
    ASSERT_EQ(step(0), WatchdogOutcome::kServiced);

    EXPECT_EQ(step(100), WatchdogOutcome::kServiced);
    EXPECT_EQ(step(300), WatchdogOutcome::kServiced);
}

TEST_F(WatchdogGateTest, HoldsTheServiceBackBeforeTheWindowOpens) {
    verifies("SWR-WDG-002", Technique::kBoundaryValues, Polarity::kViolation);
    ASSERT_EQ(step(0), WatchdogOutcome::kServiced);

    EXPECT_EQ(step(0), WatchdogOutcome::kHeldBack);
    EXPECT_EQ(step(99), WatchdogOutcome::kHeldBack);
    EXPECT_EQ(watchdog_.services, 1);
    EXPECT_EQ(step(100), WatchdogOutcome::kServiced);
}

TEST_F(WatchdogGateTest, ServiceThatTheDeviceRefusesIsTriedAgain) {
    verifies("SWR-WDG-002", Technique::kFaultInjection, Polarity::kViolation);
    watchdog_.answer = Status::kError;
    EXPECT_EQ(step(0), WatchdogOutcome::kFailed);
    EXPECT_EQ(sut_.get_service_count(), 0U);

    watchdog_.answer = Status::kOk;
    EXPECT_EQ(step(1), WatchdogOutcome::kServiced);
    EXPECT_EQ(sut_.get_service_count(), 1U);
}

TEST_F(WatchdogGateTest, WindowThatIsEmptyGoesToTheAssertionHandler) {
    verifies("SWR-WDG-002", Technique::kBoundaryValues, Polarity::kViolation);

    EXPECT_CHECK_FAILS((WatchdogGate{watchdog_, {Duration{100}, Duration{100}}}), "watchdog_gate.hpp", 1);
    EXPECT_CHECK_FAILS((WatchdogGate{watchdog_, {Duration{-1}, Duration{100}}}), "watchdog_gate.hpp", 1);
}

TEST_F(WatchdogGateTest, WindowThatIsKeptLeavesTheGateOpen) {
    verifies("SWR-WDG-003", Technique::kBoundaryValues);
    ASSERT_EQ(step(0), WatchdogOutcome::kServiced);
    ASSERT_EQ(step(200), WatchdogOutcome::kServiced);

    EXPECT_FALSE(sut_.is_closed());
}

TEST_F(WatchdogGateTest, MissedWindowClosesTheGateForGood) {
    verifies("SWR-WDG-003", Technique::kBoundaryValues, Polarity::kViolation);
    ASSERT_EQ(step(0), WatchdogOutcome::kServiced);

    EXPECT_EQ(step(201), WatchdogOutcome::kClosed);
    EXPECT_EQ(step(300), WatchdogOutcome::kClosed);
    EXPECT_EQ(step(400, GlobalStatus::kFailed), WatchdogOutcome::kClosed);
    EXPECT_EQ(watchdog_.services, 1);
}

TEST_F(WatchdogGateTest, FailureLongerThanTheWindowClosesTheGate) {
    verifies("SWR-WDG-003", Technique::kFaultInjection, Polarity::kViolation);
    ASSERT_EQ(step(0), WatchdogOutcome::kServiced);
    ASSERT_EQ(step(100, GlobalStatus::kExpired), WatchdogOutcome::kRefused);

    EXPECT_EQ(step(201, GlobalStatus::kExpired), WatchdogOutcome::kClosed);
    EXPECT_EQ(step(202), WatchdogOutcome::kClosed);
    EXPECT_EQ(watchdog_.services, 1);
}

TEST_F(WatchdogGateTest, ClockThatRunsBackwardsClosesTheGate) {
    verifies("SWR-WDG-003", Technique::kFaultInjection, Polarity::kViolation);
    ASSERT_EQ(step(1000), WatchdogOutcome::kServiced);

    EXPECT_EQ(step(999), WatchdogOutcome::kClosed);
    EXPECT_EQ(step(1100), WatchdogOutcome::kClosed);
}

}  // namespace
}  // namespace mamori::safety
