// SPDX-License-Identifier: Apache-2.0
// Goal: the watchdog closes the outputs if it is not serviced in its window, and at no other time. Method: in
// real time, with limits that do not depend on the speed of the host. Upper bounds of time:
// verification/lost_service. The rules of all ports: conformance_test.cpp.
#include "mamori/ports/posix_rt/software_watchdog.hpp"

#include <gtest/gtest.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstdio>
#include <limits>
#include <set>

#include "mamori/trace/verifies.hpp"
#include "mamori/verification/failed_check.hpp"
#include "support/fake_driver.hpp"
#include "support/threads.hpp"

namespace mamori::ports::posix_rt {
namespace {

using namespace verification;

constexpr Duration kShort = 5_ms;
constexpr Duration kHour = Duration{3'600'000'000'000};

/// Outputs that the reaction closes.
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

TEST_F(SoftwareWatchdogTest, WithServicesInTimeTheOutputsStayOpen) {
    verifies("SWR-PRT-020");
    SoftwareWatchdog sut{clock_, {0_ms, kHour}, make_reaction()};
    EXPECT_EQ(sut.service(clock_.get_now()), Status::kError) << "the watchdog is not open yet";
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
    EXPECT_EQ(outputs_.closings, 0) << "closed deliberately";
}

TEST_F(SoftwareWatchdogTest, WithoutAFirstServiceItStaysInactive) {
    verifies("SWR-PRT-020");
    SoftwareWatchdog sut{clock_, {0_ms, kShort}, make_reaction()};
    ASSERT_EQ(sut.open({}), Status::kOk);
    let_pass(kShort * 4);
    EXPECT_FALSE(sut.has_expired());
    EXPECT_EQ(sut.close(), Status::kOk);
    EXPECT_EQ(outputs_.closings, 0);
}

TEST_F(SoftwareWatchdogTest, WithoutServiceItExpiresPermanentlyAndRejectsServices) {
    verifies("SWR-PRT-020", Technique::kFaultInjection, Polarity::kViolation);
    SoftwareWatchdog sut{clock_, {0_ms, kShort}, make_reaction()};
    ASSERT_EQ(sut.open({}), Status::kOk);
    ASSERT_EQ(sut.service(clock_.get_now()), Status::kOk);
    let_pass(kShort + 1_ns);

    EXPECT_TRUE(sut.has_expired()) << "immediately, also if its thread has not reacted yet";
    EXPECT_EQ(sut.get_cause(), WatchdogCause::kLate);
    EXPECT_EQ(sut.service(clock_.get_now()), Status::kError);
    EXPECT_EQ(sut.close(), Status::kOk);
    EXPECT_TRUE(sut.has_expired());
    ASSERT_EQ(sut.open({}), Status::kOk);
    EXPECT_EQ(sut.service(clock_.get_now()), Status::kError) << "a second open() does not reset it";
    EXPECT_EQ(sut.close(), Status::kOk);
}

TEST_F(SoftwareWatchdogTest, TheTimeOfTheCallerIsNotUsed) {
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

TEST_F(SoftwareWatchdogTest, ServiceBeforeTheWindowExpiresItImmediately) {
    verifies("SWR-PRT-020", Technique::kBoundaryValues, Polarity::kViolation);
    SoftwareWatchdog sut{clock_, {kHour, kHour * 2}, make_reaction()};
    ASSERT_EQ(sut.open({}), Status::kOk);
    ASSERT_EQ(sut.service(clock_.get_now()), Status::kOk) << "the first service may occur at any time";

    EXPECT_EQ(sut.service(clock_.get_now()), Status::kError);
    EXPECT_EQ(sut.get_cause(), WatchdogCause::kEarly);
    wait_for_closing();
    EXPECT_EQ(sut.close(), Status::kOk);
}

TEST_F(SoftwareWatchdogTest, ServiceInsideTheWindowIsAccepted) {
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

TEST_F(SoftwareWatchdogTest, OutputsAreClosedOnceWhileTheFaultyCodeHangs) {
    verifies("SWR-PRT-021", Technique::kFaultInjection, Polarity::kViolation);
    SoftwareWatchdog sut{clock_, {0_ms, kShort}, make_reaction()};
    ASSERT_EQ(sut.open({}), Status::kOk);
    const Instant before = clock_.get_now();
    ASSERT_EQ(sut.service(before), Status::kOk);

    while (outputs_.closings == 0) {  // this is the code that hangs
    }
    EXPECT_GT(Instant{outputs_.closed_at_ns.load()} - before, kShort) << "not before the timeout";
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
        EXPECT_EQ(outputs_.closings, i) << "has_expired() and the outputs agree";
    }
}

TEST_F(SoftwareWatchdogTest, AWatchdogThatIsOpenedAgainWatchesAndHasACrashStack) {
    verifies("SWR-PRT-021", Technique::kStateTransition, Polarity::kViolation);
    static std::atomic<int> closings{0};
    static std::atomic<bool> has_crash_stack{false};
    closings = 0;
    const auto close = [](void*) noexcept {
        stack_t stack{};
        static_cast<void>(::sigaltstack(nullptr, &stack));
        has_crash_stack = stack.ss_flags != SS_DISABLE;
        ++closings;
    };
    SoftwareWatchdog sut{clock_, {0_ms, 100_ms}, {close, nullptr, false}};
    ASSERT_EQ(sut.open({}), Status::kOk);
    ASSERT_EQ(sut.close(), Status::kOk);
    ASSERT_EQ(sut.open({}), Status::kOk);
    ASSERT_EQ(sut.service(clock_.get_now()), Status::kOk);
    while (closings == 0) {
        let_pass(1_ms);
    }
    EXPECT_TRUE(has_crash_stack);
    EXPECT_EQ(sut.close(), Status::kOk);
    EXPECT_EQ(closings, 1);
}

TEST_F(SoftwareWatchdogTest, ASignalOfACrashReachesItsThreadAndEndsNoWait) {
    verifies("SWR-PRT-021", Technique::kFaultInjection, Polarity::kViolation);
    static std::atomic<int> signals{0};
    signals = 0;
    struct sigaction action{};
    struct sigaction before{};
    action.sa_handler = [](int) { ++signals; };  // without SA_RESTART: the wait ends early
    ASSERT_EQ(::sigaction(SIGTRAP, &action, &before), 0);
    const std::set<pid_t> others = find_threads();
    SoftwareWatchdog sut{clock_, {0_ms, kHour}, make_reaction()};
    ASSERT_EQ(sut.open({}), Status::kOk);
    pid_t thread = 0;
    for (const pid_t each : find_threads()) {
        thread = others.count(each) == 0U ? each : thread;
    }
    for (int i = 1; i <= 2; ++i) {  // before and after the first service
        let_pass(2_ms);             // usually it waits then
        ASSERT_EQ(::syscall(SYS_tgkill, ::getpid(), thread, SIGTRAP), 0);
        while (signals < i) {
            let_pass(1_ms);
        }
        EXPECT_EQ(sut.service(clock_.get_now()), Status::kOk);
    }
    EXPECT_FALSE(sut.has_expired());
    EXPECT_EQ(sut.close(), Status::kOk);
    EXPECT_EQ(outputs_.closings, 0);
    ASSERT_EQ(::sigaction(SIGTRAP, &before, nullptr), 0);
}

/// Stops until the test advances it, and notes each instant that the thread waits for. No wait ends.
class StillClock final : public TimeSource {
  public:
    std::int64_t read_ns() const noexcept override { return now_ns; }
    void wait_until(std::int64_t) const noexcept override {}
    std::int64_t to_monotonic(std::int64_t ns) const noexcept override {
        until_ns = ns;
        ++waits;
        return get_monotonic_clock().read_ns() + kHour.ns;
    }
    /// @return instant of the wait with this number, from 1.
    Instant wait_for(int number) const {
        while (waits < number) {
            get_monotonic_clock().wait_until(get_monotonic_clock().read_ns() + 1'000'000);
        }
        return Instant{until_ns};
    }
    std::atomic<std::int64_t> now_ns{0};
    mutable std::atomic<std::int64_t> until_ns{-1};
    mutable std::atomic<int> waits{0};
};

TEST_F(SoftwareWatchdogTest, BothLimitsOfTheWindowAreInTime) {
    verifies("SWR-PRT-020", Technique::kBoundaryValues, Polarity::kViolation);
    for (const std::int64_t elapsed : {9, 10, 20, 21}) {
        StillClock source;
        const FrameClock clock = FrameClock::starting_in(0_ms, source);
        SoftwareWatchdog sut{clock, {Duration{10}, Duration{20}}, make_reaction()};
        ASSERT_EQ(sut.open({}), Status::kOk);
        ASSERT_EQ(sut.service(Instant{}), Status::kOk);
        source.now_ns = elapsed;
        EXPECT_EQ(sut.has_expired(), elapsed == 21) << elapsed;
        EXPECT_EQ(sut.is_watching(), elapsed != 21) << elapsed;
        const bool is_in_time = elapsed == 10 || elapsed == 20;
        EXPECT_EQ(sut.service(Instant{}), is_in_time ? Status::kOk : Status::kError) << elapsed;
        const WatchdogCause fault = elapsed == 9 ? WatchdogCause::kEarly : WatchdogCause::kLate;
        EXPECT_EQ(sut.get_cause(), is_in_time ? WatchdogCause::kNone : fault) << elapsed;
        EXPECT_EQ(sut.close(), Status::kOk);
    }
    EXPECT_EQ(outputs_.closings, 2);
}

TEST_F(SoftwareWatchdogTest, TheThreadWaitsForTheFirstInstantAfterTheWindow) {
    verifies("SWR-PRT-021", Technique::kBoundaryValues);
    StillClock source;
    const FrameClock clock = FrameClock::starting_in(0_ms, source);
    SoftwareWatchdog sut{clock, {0_ms, 20_ms}, make_reaction()};
    ASSERT_EQ(sut.open({}), Status::kOk);
    ASSERT_EQ(sut.service(Instant{}), Status::kOk);
    EXPECT_EQ(source.wait_for(1), Instant{} + 20_ms + 1_ns);
    EXPECT_EQ(sut.close(), Status::kOk);
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

TEST_F(SoftwareWatchdogTest, ProcessIsEndedAfterTheOutputsOnRequest) {
    verifies("SWR-PRT-021", Technique::kFaultInjection, Polarity::kViolation);
    EXPECT_EXIT(hang_under_a_watchdog_that_ends_the_process(clock_), ::testing::KilledBySignal(SIGABRT),
                "^outputs closed\n$");
}

TEST_F(SoftwareWatchdogTest, DestructionWhileOpenAndInvalidParametersAreContractViolations) {
    verifies("SWR-PRT-021", Technique::kErrorGuessing, Polarity::kViolation);
    EXPECT_CHECK_FAILS(leave_it_open(clock_, make_reaction()), "software_watchdog.hpp", 3);
    EXPECT_CHECK_FAILS(make(clock_, {1_ms, 1_ms}, make_reaction()), "software_watchdog.hpp", 1);
    EXPECT_CHECK_FAILS(make(clock_, {Duration{-1}, 1_ms}, make_reaction()), "software_watchdog.hpp", 1);
    EXPECT_CHECK_FAILS(make(clock_, {0_ms, 1_ms}, {nullptr}), "software_watchdog.hpp", 2);
}

TEST_F(SoftwareWatchdogTest, PrivilegesOfTheThreadAreReportedAndADenialDoesNotStopIt) {
    verifies("SWR-PRT-021", Technique::kErrorGuessing);
    SoftwareWatchdog sut{clock_, {0_ms, kShort}, make_reaction()};
    ASSERT_EQ(sut.open({0, 100'000}), Status::kOk);
    EXPECT_FALSE(sut.get_priority_right().is_granted);
    ASSERT_EQ(sut.service(clock_.get_now()), Status::kOk);
    wait_for_closing();
    EXPECT_EQ(sut.close(), Status::kOk);
    SoftwareWatchdog other{clock_, {0_ms, kShort}, make_reaction()};
    ASSERT_EQ(other.open({}), Status::kOk);
    EXPECT_TRUE(other.get_priority_right().is_granted) << "no privilege was requested";
    EXPECT_EQ(other.close(), Status::kOk);
}

class ChainedWatchdogTest : public SoftwareWatchdogTest {
  protected:
    ChainedWatchdogTest() { EXPECT_EQ(device_.open("/dev/fake", 1000_ms), Status::kOk); }
    ~ChainedWatchdogTest() override { static_cast<void>(device_.disarm()); }
    /// Returns after `more` further services of the device.
    void wait_for_services(int more) const {
        const int wanted = driver_.services + more;
        while (driver_.services < wanted) {
            let_pass(1_ms);
        }
    }

    WatchdogDevice device_{kFakeCalls};
};

TEST_F(ChainedWatchdogTest, DeviceIsServicedBeforeAndAfterTheFirstService) {
    verifies("SWR-PRT-025");
    SoftwareWatchdog sut{clock_, {0_ms, kHour}, make_reaction()};
    ASSERT_EQ(sut.open({}, &device_), Status::kOk);
    wait_for_services(2);
    ASSERT_EQ(sut.service(clock_.get_now()), Status::kOk);
    const Instant before = clock_.get_now();
    wait_for_services(3);
    EXPECT_GE(clock_.get_now() - before, 500_ms) << "four times per second, not with each service";
    EXPECT_FALSE(sut.has_expired());
    EXPECT_EQ(sut.close(), Status::kOk);
    EXPECT_TRUE(driver_.is_running) << "the owner disarms it";
}

TEST_F(ChainedWatchdogTest, TheThreadWaitsForADeviceThatIsDueBeforeTheEndOfTheWindow) {
    verifies("SWR-PRT-025", Technique::kBoundaryValues);
    for (const Duration longest : {300_ms, 200_ms}) {
        StillClock source;
        const FrameClock clock = FrameClock::starting_in(0_ms, source);
        SoftwareWatchdog sut{clock, {0_ms, longest}, make_reaction()};
        const int before = driver_.services;
        ASSERT_EQ(sut.open({}, &device_), Status::kOk);
        EXPECT_EQ(source.wait_for(1), Instant{} + 250_ms) << "four times within the timeout of 1 s";
        EXPECT_EQ(driver_.services, before + 1);
        ASSERT_EQ(sut.service(Instant{}), Status::kOk);
        EXPECT_EQ(source.wait_for(2), Instant{} + (longest < 250_ms ? longest + 1_ns : 250_ms));
        EXPECT_EQ(driver_.services, before + 1) << "it is not due yet";
        EXPECT_EQ(sut.close(), Status::kOk);
    }
    EXPECT_EQ(outputs_.closings, 0);
}

TEST_F(ChainedWatchdogTest, DeviceIsServicedAtOnceAlsoBeforeTheTimeLineBegins) {
    verifies("SWR-PRT-025", Technique::kBoundaryValues);
    const FrameClock clock = FrameClock::starting_in(kHour);
    SoftwareWatchdog sut{clock, {0_ms, kHour * 2}, make_reaction()};
    ASSERT_EQ(sut.open({}, &device_), Status::kOk);
    wait_for_services(1);
    ASSERT_EQ(sut.service(clock.get_now()), Status::kOk);
    wait_for_services(1);
    EXPECT_LT(clock.get_now(), Instant{0});
    EXPECT_EQ(sut.close(), Status::kOk);
    EXPECT_EQ(outputs_.closings, 0);
}

TEST_F(ChainedWatchdogTest, DeviceIsNotServicedAfterTheWatchdogHasExpired) {
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

TEST_F(ChainedWatchdogTest, DeviceThatRejectsAServiceExpiresTheWatchdog) {
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

TEST_F(ChainedWatchdogTest, ClosedDeviceIsRejected) {
    verifies("SWR-PRT-025", Technique::kErrorGuessing, Polarity::kViolation);
    WatchdogDevice closed{kFakeCalls};
    SoftwareWatchdog sut{clock_, {0_ms, kHour}, make_reaction()};
    EXPECT_EQ(sut.open({}, &closed), Status::kPreconditionNotMet);
    EXPECT_EQ(sut.service(clock_.get_now()), Status::kError);
}

}  // namespace
}  // namespace mamori::ports::posix_rt
