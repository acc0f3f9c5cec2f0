// SPDX-License-Identifier: Apache-2.0
// Goal: the time line begins at its epoch, and a sleep ends at its instant or later, also with interruptions.
// Method: instants on both sides of the epoch and of full seconds; a timer that sends signals meanwhile.
#include "mamori/ports/posix_rt/frame_clock.hpp"

#include <gtest/gtest.h>
#include <sys/time.h>

#include <csignal>
#include <limits>

#include "mamori/trace/verifies.hpp"
#include "mamori/verification/failed_check.hpp"
#include "support/fake_clock.hpp"

namespace mamori::ports::posix_rt {
namespace {

using namespace verification;
using literals::operator""_ms;
using literals::operator""_s;

std::int64_t to_ns(const timespec& time) {
    return static_cast<std::int64_t>(time.tv_sec) * 1'000'000'000 + time.tv_nsec;
}

TEST(FrameClockTest, TheEpochIsInTheFutureAtFirst) {
    verifies("SWR-PRT-001");
    const FrameClock sut = FrameClock::starting_in(3600_s);

    const Instant first = sut.get_now();
    EXPECT_LT(first, Instant{0});
    EXPECT_GE(first, Instant{0} - 3600_s);
    EXPECT_GE(sut.get_now(), first);
}

TEST(FrameClockTest, InstantsAreThoseOfTheMonotonicClock) {
    verifies("SWR-PRT-001", Technique::kBoundaryValues);
    const FrameClock sut = FrameClock::starting_in(0_ms);
    const std::int64_t epoch = to_ns(sut.to_timespec(Instant{0}));

    timespec now{};
    ASSERT_EQ(clock_gettime(CLOCK_MONOTONIC, &now), 0);
    EXPECT_LE(epoch, to_ns(now));
    for (const std::int64_t at :
         {std::int64_t{-1}, std::int64_t{1}, std::int64_t{999'999'999}, std::int64_t{1'000'000'000}}) {
        const timespec time = sut.to_timespec(Instant{at});
        EXPECT_EQ(to_ns(time), epoch + at);
        EXPECT_GE(time.tv_nsec, 0);
        EXPECT_LT(time.tv_nsec, 1'000'000'000);
    }
    EXPECT_EQ(to_ns(sut.to_timespec(Instant{-epoch - 1})), 0) << "before the clock's own zero";
    EXPECT_EQ(to_ns(sut.to_timespec(Instant{-epoch})), 0);
    EXPECT_EQ(to_ns(sut.to_timespec(Instant{-epoch + 1})), 1);
}

TEST(FrameClockTest, AnInterruptedSleepDoesNotEndEarly) {
    verifies("SWR-PRT-001", Technique::kFaultInjection, Polarity::kViolation);
    static volatile std::sig_atomic_t g_signals = 0;
    struct sigaction action{};
    struct sigaction before{};
    action.sa_handler = [](int) { g_signals = g_signals + 1; };
    ASSERT_EQ(sigaction(SIGALRM, &action, &before), 0);
    const itimerval each_2_ms{{0, 2000}, {0, 2000}};
    ASSERT_EQ(setitimer(ITIMER_REAL, &each_2_ms, nullptr), 0);
    const FrameClock sut = FrameClock::starting_in(0_ms);

    sut.wait_until(Instant{0} + 50_ms);
    const Instant woken = sut.get_now();

    const itimerval none{};
    ASSERT_EQ(setitimer(ITIMER_REAL, &none, nullptr), 0);
    ASSERT_EQ(sigaction(SIGALRM, &before, nullptr), 0);
    EXPECT_GE(woken, Instant{0} + 50_ms);
    EXPECT_GT(g_signals, 0);
}

TEST(FrameClockTest, AnInstantThatHasPassedIsNotWaitedFor) {
    verifies("SWR-PRT-001", Technique::kBoundaryValues);
    const FrameClock sut = FrameClock::starting_in(0_ms);

    sut.wait_until(Instant{0} - 1_s);
    sut.wait_until(sut.get_now());
    SUCCEED() << "wait_until() returned";
}

TEST(FrameClockTest, AnEpochInThePastIsAContractViolation) {
    verifies("SWR-PRT-001", Technique::kBoundaryValues, Polarity::kViolation);
    EXPECT_CHECK_FAILS(static_cast<void>(FrameClock::starting_in(Duration{-1})), "frame_clock.cpp", 2);
}

constexpr Instant kLast{std::numeric_limits<std::int64_t>::max()};
constexpr Instant kFirst{std::numeric_limits<std::int64_t>::min()};

TEST(FrameClockTest, SumsStayWithinTheRangeOnBothSidesOfItsEnds) {
    verifies("SWR-PRT-044", Technique::kBoundaryValues);
    EXPECT_EQ(add_saturating(Instant{5}, Duration{-1}), Instant{4});
    EXPECT_EQ(add_saturating(Instant{-5}, Duration{1}), Instant{-4});
    EXPECT_EQ(add_saturating(kLast - Duration{1}, Duration{1}), kLast);
    EXPECT_EQ(add_saturating(kLast, Duration{1}), kLast);
    EXPECT_EQ(add_saturating(kLast, Duration{kLast.ns}), kLast);
    EXPECT_EQ(add_saturating(kLast, Duration{-1}), kLast - Duration{1});
    EXPECT_EQ(add_saturating(kFirst + Duration{1}, Duration{-1}), kFirst);
    EXPECT_EQ(add_saturating(kFirst, Duration{-1}), kFirst);
    EXPECT_EQ(add_saturating(kFirst, Duration{kFirst.ns}), kFirst);
    EXPECT_EQ(add_saturating(kFirst, Duration{kLast.ns}), Instant{-1});
}

TEST(FrameClockTest, AnInstantBeyondTheRangeIsInTheFuture) {
    verifies("SWR-PRT-044", Technique::kBoundaryValues, Polarity::kViolation);
    FakeClock source{1'000};
    const FrameClock sut = FrameClock::starting_in(Duration{0}, source);
    const Instant last_exact = kLast - Duration{1'000};
    EXPECT_EQ(to_ns(sut.to_timespec(last_exact)), kLast.ns);
    EXPECT_EQ(to_ns(sut.to_timespec(last_exact + Duration{1})), kLast.ns);
    EXPECT_EQ(to_ns(sut.to_timespec(kLast)), kLast.ns) << "not the clock's zero";

    sut.wait_until(kLast);
    EXPECT_EQ(source.slept_until_ns, kLast.ns);
    const FrameClock never = FrameClock::starting_in(Duration{kLast.ns}, source);
    EXPECT_LT(never.get_now(), Instant{0}) << "an epoch at the end of the range is in the future, too";
}

}  // namespace
}  // namespace mamori::ports::posix_rt
