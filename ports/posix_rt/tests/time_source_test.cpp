// SPDX-License-Identifier: Apache-2.0
// Goal: the time line uses the clocks of Linux by default, and a replaced clock determines its readings and
// waits. Method: comparison with direct readings of the Linux clocks; a fake clock.
#include "mamori/ports/posix_rt/time_source.hpp"

#include <gtest/gtest.h>
#include <sys/syscall.h>
#include <time.h>

#include <cerrno>

#include "mamori/ports/posix_rt/frame_clock.hpp"
#include "mamori/trace/verifies.hpp"
#include "mamori/verification/failed_check.hpp"
#include "support/fake_clock.hpp"
#include "support/refused_call.hpp"

namespace mamori::ports::posix_rt {
namespace {

using namespace verification;
using literals::operator""_ms;
using literals::operator""_ns;

std::int64_t read(clockid_t clock) {
    timespec now{};
    EXPECT_EQ(clock_gettime(clock, &now), 0);
    return static_cast<std::int64_t>(now.tv_sec) * 1'000'000'000 + now.tv_nsec;
}

TEST(TimeSourceTest, DefaultsAreTheMonotonicAndTheRawClock) {
    verifies("SWR-PRT-030");
    const std::int64_t before = read(CLOCK_MONOTONIC);
    const std::int64_t shown = get_monotonic_clock().read_ns();
    EXPECT_LE(before, shown);
    EXPECT_LE(shown, read(CLOCK_MONOTONIC));
    EXPECT_EQ(get_monotonic_clock().to_monotonic(12), 12);

    const std::int64_t raw_before = read(CLOCK_MONOTONIC_RAW);
    const std::int64_t raw = get_raw_clock().read_ns();
    EXPECT_LE(raw_before, raw);
    EXPECT_LE(raw, read(CLOCK_MONOTONIC_RAW));
}

TEST(TimeSourceTest, ASleepThatLinuxRefusesEndsTheProcess) {
    verifies("SWR-PRT-001", Technique::kFaultInjection, Polarity::kViolation);
    EXPECT_CHECK_FAILS(
        {
            static_cast<void>(refuse_call(SYS_clock_nanosleep, EINVAL, false));
            get_monotonic_clock().wait_until(1);
        },
        "time_source.cpp", 2);
}

TEST(TimeSourceTest, ReplacedClockDeterminesReadingsAndWaits) {
    verifies("SWR-PRT-030", Technique::kInterface);
    FakeClock source{5'000'000'000};
    const FrameClock clock = FrameClock::starting_in(3_ms, source);
    EXPECT_EQ(clock.get_now(), Instant{-3'000'000});

    source.now_ns += 4'000'000;
    EXPECT_EQ(clock.get_now(), Instant{1'000'000});
    clock.wait_until(Instant{0} + 2_ms);
    EXPECT_EQ(source.slept_until_ns, 5'005'000'000);
    source.slept_until_ns = 0;
    clock.wait_until(Instant{0} + 1_ms);
    EXPECT_EQ(source.slept_until_ns, 0) << "the instant has been reached";
    source.monotonic_offset_ns = -7;
    const timespec at = clock.to_timespec(Instant{10});
    EXPECT_EQ(at.tv_sec, 5);
    EXPECT_EQ(at.tv_nsec, 3'000'003);
}

}  // namespace
}  // namespace mamori::ports::posix_rt
