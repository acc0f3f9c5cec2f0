// SPDX-License-Identifier: Apache-2.0
// Goal: the watchdog closes the outputs by itself when it is not served in its window, and at no other time.
// Method: by the clock, with limits so far apart that no speed of the machine decides; nothing is asked of an
// upper bound of time here: that is verification/lost_service. The rules of every port: conformance_test.cpp.
#include "mamori/ports/posix_rt/software_watchdog.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <csignal>
#include <cstdio>
#include <limits>

#include "mamori/trace/verifies.hpp"
#include "mamori/verification/failed_check.hpp"
#include "support/fake_driver.hpp"

namespace mamori::ports::posix_rt {
namespace {

using namespace verification;

constexpr Duration kShort = 5_ms;
constexpr Duration kHour = Duration{3'600'000'000'000};

/// What the reaction takes away.
struct Outputs {
    std::atomic<int> closings{0};
    std::atomic<std::int64_t> closed_at_ns{0};
    const FrameClock* clock;

    static void close(void* self) noexcept {
        auto& outputs = *static_cast<Outputs*>(self);
        outputs.closed_at_ns.store(outputs.clock->get_now().ns);
        outputs.closings.fetch_add(1);
    }
};

class SoftwareWatchdogTest : public ::testing::Test {
  protected:
    SoftwareWatchdogTest() {
        FakeDriver::reset();
        outputs_.clock = &clock_;
    }

    WatchdogReaction make_reaction() { return {&Outputs::close, &outputs_, false}; }
    void let_pass(Duration time) const { clock_.wait_until(clock_.get_now() + time); }
    void wait_for_closing() const {
        while (outputs_.closings == 0) {
            let_pass(1_ms);
        }
    }

    const FrameClock clock_ = FrameClock::starting_in(0_ms);
    Outputs outputs_{};
    FakeDriver& driver_ = FakeDriver::get();
};

TEST_F(SoftwareWatchdogTest, ServedInTimeItTakesEachServiceAndLeavesTheOutputsAlone) {
    verifies("SWR-PRT-020");
    SoftwareWatchdog sut{clock_, {0_ms, kHour}, make_reaction()};
    EXPECT_EQ(sut.service(clock_.get_now()), Status::kError) << "nobody watches yet";
    ASSERT_EQ(sut.open({}), Status::kOk);
    EXPECT_EQ(sut.open({}), Status::kPreconditionNotMet);
    for (int i = 0; i < 20; ++i) {
        EXPECT_EQ(sut.service(clock_.get_now()), Status::kOk);
    }

    EXPECT_FALSE(sut.has_expired());
    EXPECT_EQ(sut.close(), Status::kOk);
    EXPECT_EQ(sut.close(), Status::kPreconditionNotMet);
    EXPECT_EQ(sut.service(clock_.get_now()), Status::kError);
    EXPECT_FALSE(sut.has_expired());
    EXPECT_EQ(outputs_.closings, 0) << "closed on purpose";
}

TEST_F(SoftwareWatchdogTest, WithoutAFirstServiceItStaysSilent) {
    verifies("SWR-PRT-020");
    SoftwareWatchdog sut{clock_, {0_ms, kShort}, make_reaction()};
    ASSERT_EQ(sut.open({}), Status::kOk);
    let_pass(kShort * 4);
    EXPECT_FALSE(sut.has_expired());
    EXPECT_EQ(sut.close(), Status::kOk);
    EXPECT_EQ(outputs_.closings, 0);
}

TEST_F(SoftwareWatchdogTest, NotServedItExpiresForGoodAndTakesNoServiceAnyMore) {
    verifies("SWR-PRT-020", Technique::kFaultInjection, Polarity::kViolation);
    SoftwareWatchdog sut{clock_, {0_ms, kShort}, make_reaction()};
    ASSERT_EQ(sut.open({}), Status::kOk);
    ASSERT_EQ(sut.service(clock_.get_now()), Status::kOk);
    let_pass(kShort + 1_ns);

    EXPECT_TRUE(sut.has_expired()) << "from the instant on, wherever its thread is";
    EXPECT_EQ(sut.get_cause(), WatchdogCause::kLate);
    EXPECT_EQ(sut.service(clock_.get_now()), Status::kError);
    EXPECT_EQ(sut.close(), Status::kOk);
    EXPECT_TRUE(sut.has_expired());
    ASSERT_EQ(sut.open({}), Status::kOk);
    EXPECT_EQ(sut.service(clock_.get_now()), Status::kError) << "opening it again helps nothing";
    EXPECT_EQ(sut.close(), Status::kOk);
}

TEST_F(SoftwareWatchdogTest, WhatTheCallerTakesForTheTimeIsNotAsked) {
    verifies("SWR-PRT-020", Technique::kFaultInjection, Polarity::kViolation);
    SoftwareWatchdog sut{clock_, {0_ms, kShort}, make_reaction()};
    ASSERT_EQ(sut.open({}), Status::kOk);
    const Instant stuck = clock_.get_now();
    ASSERT_EQ(sut.service(stuck + kHour), Status::kOk);
    let_pass(kShort + 1_ns);
    EXPECT_EQ(sut.service(stuck), Status::kError);
    EXPECT_TRUE(sut.has_expired());
    EXPECT_EQ(sut.close(), Status::kOk);
}

TEST_F(SoftwareWatchdogTest, ServiceBeforeTheWindowExpiresItAtOnce) {
    verifies("SWR-PRT-020", Technique::kBoundaryValues, Polarity::kViolation);
    SoftwareWatchdog sut{clock_, {kHour, kHour * 2}, make_reaction()};
    ASSERT_EQ(sut.open({}), Status::kOk);
    ASSERT_EQ(sut.service(clock_.get_now()), Status::kOk) << "the first has no distance to keep";

    EXPECT_EQ(sut.service(clock_.get_now()), Status::kError);
    EXPECT_EQ(sut.get_cause(), WatchdogCause::kEarly);
    wait_for_closing();
    EXPECT_EQ(sut.close(), Status::kOk);
}

TEST_F(SoftwareWatchdogTest, ServiceInsideTheWindowIsTaken) {
    verifies("SWR-PRT-020", Technique::kBoundaryValues);
    SoftwareWatchdog sut{clock_, {kShort, kHour}, make_reaction()};
    ASSERT_EQ(sut.open({}), Status::kOk);
    for (int i = 0; i < 3; ++i) {
        EXPECT_EQ(sut.service(clock_.get_now()), Status::kOk);
        let_pass(kShort + 1_ms);
    }
    EXPECT_EQ(sut.close(), Status::kOk);
    EXPECT_EQ(outputs_.closings, 0);
}

TEST_F(SoftwareWatchdogTest, WindowWithoutAnEndNeverExpires) {
    verifies("SWR-PRT-044", Technique::kBoundaryValues, Polarity::kViolation);
    constexpr Duration kLongest{std::numeric_limits<std::int64_t>::max()};
    SoftwareWatchdog sut{clock_, {0_ms, kLongest}, make_reaction()};
    ASSERT_EQ(sut.open({}), Status::kOk);
    ASSERT_EQ(sut.service(clock_.get_now()), Status::kOk);
    let_pass(kShort);
    EXPECT_FALSE(sut.has_expired());
    EXPECT_EQ(sut.close(), Status::kOk);
    EXPECT_EQ(outputs_.closings, 0);
}

TEST_F(SoftwareWatchdogTest, OutputsAreClosedOnceWhileTheGuiltyCodeHangs) {
    verifies("SWR-PRT-021", Technique::kFaultInjection, Polarity::kViolation);
    SoftwareWatchdog sut{clock_, {0_ms, kShort}, make_reaction()};
    ASSERT_EQ(sut.open({}), Status::kOk);
    const Instant before = clock_.get_now();
    ASSERT_EQ(sut.service(before), Status::kOk);

    while (outputs_.closings == 0) {  // this is the code that hangs
    }
    EXPECT_GT(Instant{outputs_.closed_at_ns.load()} - before, kShort) << "not before the time is over";
    let_pass(kShort * 3);
    static_cast<void>(sut.service(clock_.get_now()));
    EXPECT_EQ(sut.close(), Status::kOk);
    EXPECT_EQ(outputs_.closings, 1);
}

TEST_F(SoftwareWatchdogTest, ClosingItLateClosesTheOutputsToo) {
    verifies("SWR-PRT-021", Technique::kBoundaryValues, Polarity::kViolation);
    for (int i = 1; i <= 30; ++i) {
        SoftwareWatchdog sut{clock_, {0_ms, 100_us}, make_reaction()};
        ASSERT_EQ(sut.open({}), Status::kOk);
        ASSERT_EQ(sut.service(clock_.get_now()), Status::kOk);
        while (!sut.has_expired()) {
        }
        EXPECT_EQ(sut.close(), Status::kOk);
        EXPECT_EQ(outputs_.closings, i) << "what has_expired() said is so";
    }
}

void hang_under_a_watchdog_that_ends_the_process(const FrameClock& clock) {
    const auto tell = [](void*) noexcept { static_cast<void>(std::fputs("outputs closed\n", stderr)); };
    SoftwareWatchdog sut{clock, {0_ms, kShort}, {tell, nullptr, true}};
    if (sut.open({}) == Status::kOk && sut.service(clock.get_now()) == Status::kOk) {
        for (;;) {
            static_cast<void>(clock.get_now());
        }
    }
}

void leave_it_open(const FrameClock& clock, WatchdogReaction reaction) {
    SoftwareWatchdog sut{clock, {0_ms, kHour}, reaction};
    static_cast<void>(sut.open({}));
}

void make(const FrameClock& clock, safety::WatchdogWindow window, WatchdogReaction reaction) {
    const SoftwareWatchdog sut{clock, window, reaction};
}

TEST_F(SoftwareWatchdogTest, ProcessIsEndedAfterTheOutputsWhereThatIsAskedFor) {
    verifies("SWR-PRT-021", Technique::kFaultInjection, Polarity::kViolation);
    EXPECT_EXIT(hang_under_a_watchdog_that_ends_the_process(clock_), ::testing::KilledBySignal(SIGABRT),
                "^outputs closed\n$");
}

TEST_F(SoftwareWatchdogTest, OneThatGoesWhileItIsOpenAndOneThatCannotWatchAreOwnBugs) {
    verifies("SWR-PRT-021", Technique::kErrorGuessing, Polarity::kViolation);
    EXPECT_CHECK_FAILS(leave_it_open(clock_, make_reaction()), "software_watchdog.hpp", 3);
    EXPECT_CHECK_FAILS(make(clock_, {1_ms, 1_ms}, make_reaction()), "software_watchdog.hpp", 1);
    EXPECT_CHECK_FAILS(make(clock_, {Duration{-1}, 1_ms}, make_reaction()), "software_watchdog.hpp", 1);
    EXPECT_CHECK_FAILS(make(clock_, {0_ms, 1_ms}, {nullptr}), "software_watchdog.hpp", 2);
}

TEST_F(SoftwareWatchdogTest, RightsOfTheThreadAreToldAndARefusalDoesNotStopIt) {
    verifies("SWR-PRT-021", Technique::kErrorGuessing);
    SoftwareWatchdog sut{clock_, {0_ms, kShort}, make_reaction()};
    ASSERT_EQ(sut.open({0, 100'000}), Status::kOk);
    EXPECT_FALSE(sut.get_priority_right().is_granted);
    ASSERT_EQ(sut.service(clock_.get_now()), Status::kOk);
    wait_for_closing();
    EXPECT_EQ(sut.close(), Status::kOk);
    SoftwareWatchdog other{clock_, {0_ms, kShort}, make_reaction()};
    ASSERT_EQ(other.open({}), Status::kOk);
    EXPECT_TRUE(other.get_priority_right().is_granted) << "nothing was asked for";
    EXPECT_EQ(other.close(), Status::kOk);
}

class ChainedWatchdogTest : public SoftwareWatchdogTest {
  protected:
    ChainedWatchdogTest() { EXPECT_EQ(device_.open("/dev/fake", 1000_ms), Status::kOk); }
    ~ChainedWatchdogTest() override { static_cast<void>(device_.disarm()); }
    /// Returns when the device has been served `more` times more.
    void wait_for_services(int more) const {
        const int wanted = driver_.services + more;
        while (driver_.services < wanted) {
            let_pass(1_ms);
        }
    }

    WatchdogDevice device_{kFakeCalls};
};

TEST_F(ChainedWatchdogTest, DeviceIsServedWhileTheWatchdogIsSilentAndWhileItIsServed) {
    verifies("SWR-PRT-025");
    SoftwareWatchdog sut{clock_, {0_ms, kHour}, make_reaction()};
    ASSERT_EQ(sut.open({}, &device_), Status::kOk);
    wait_for_services(2);
    ASSERT_EQ(sut.service(clock_.get_now()), Status::kOk);
    const Instant before = clock_.get_now();
    wait_for_services(3);
    EXPECT_GE(clock_.get_now() - before, 500_ms) << "four times in its second, not with each service";
    EXPECT_FALSE(sut.has_expired());
    EXPECT_EQ(sut.close(), Status::kOk);
    EXPECT_TRUE(driver_.is_running) << "the owner disarms it";
}

TEST_F(ChainedWatchdogTest, DeviceIsNotServedAnyMoreOnceTheWatchdogHasExpired) {
    verifies("SWR-PRT-025", Technique::kFaultInjection, Polarity::kViolation);
    SoftwareWatchdog sut{clock_, {0_ms, kShort}, make_reaction()};
    ASSERT_EQ(sut.open({}, &device_), Status::kOk);
    wait_for_services(1);
    ASSERT_EQ(sut.service(clock_.get_now()), Status::kOk);
    wait_for_closing();
    const int services = driver_.services;
    let_pass(600_ms);
    EXPECT_EQ(driver_.services, services);
    EXPECT_EQ(sut.close(), Status::kOk);
}

TEST_F(ChainedWatchdogTest, DeviceThatDoesNotTakeAServiceExpiresTheWatchdog) {
    verifies("SWR-PRT-025", Technique::kFaultInjection, Polarity::kViolation);
    SoftwareWatchdog sut{clock_, {0_ms, kHour}, make_reaction()};
    ASSERT_EQ(sut.open({}, &device_), Status::kOk);
    ASSERT_EQ(sut.service(clock_.get_now()), Status::kOk);
    driver_.write_error = EIO;

    wait_for_closing();
    EXPECT_EQ(sut.get_cause(), WatchdogCause::kDevice);
    EXPECT_EQ(sut.service(clock_.get_now()), Status::kError);
    EXPECT_EQ(sut.close(), Status::kOk);
    driver_.write_error = 0;
}

TEST_F(ChainedWatchdogTest, DeviceThatIsClosedIsRefused) {
    verifies("SWR-PRT-025", Technique::kErrorGuessing, Polarity::kViolation);
    WatchdogDevice closed{kFakeCalls};
    SoftwareWatchdog sut{clock_, {0_ms, kHour}, make_reaction()};
    EXPECT_EQ(sut.open({}, &closed), Status::kPreconditionNotMet);
    EXPECT_EQ(sut.service(clock_.get_now()), Status::kError);
}

}  // namespace
}  // namespace mamori::ports::posix_rt
