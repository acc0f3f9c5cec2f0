// SPDX-License-Identifier: Apache-2.0
// Goal: the faults that the runs rely on are real: a wrong rate, a late sleep, a late deadline, a held mutex,
// page faults. Method: each fault is compared with the clock and the counters of Linux; no test depends on
// the speed of the host.
#include "faulty_time.hpp"

#include <gtest/gtest.h>
#include <sys/mman.h>

#include <thread>

#include "inversion.hpp"
#include "mamori/ports/posix_rt/real_time_rights.hpp"
#include "mamori/trace/verifies.hpp"
#include "page_storm.hpp"

namespace mamori::time_faults {
namespace {

using ports::posix_rt::FrameClock;
using ports::posix_rt::get_monotonic_clock;
using verification::Technique;
using verification::verifies;

/// Shown time that elapses while `sut` is read between two readings of the true clock.
void expect_rate(const FaultyTime& sut, std::int64_t ppm) {
    const std::int64_t before = get_monotonic_clock().read_ns();
    const std::int64_t first = sut.read_ns();
    const std::int64_t first_done = get_monotonic_clock().read_ns();
    get_monotonic_clock().wait_until(first_done + 5'000'000);
    const std::int64_t second_from = get_monotonic_clock().read_ns();
    const std::int64_t second = sut.read_ns();
    const std::int64_t after = get_monotonic_clock().read_ns();

    const std::int64_t shown = (second - first) * 1000 / (1'000'000 + ppm) * 1000;
    EXPECT_GE(shown + 1000, second_from - first_done);
    EXPECT_LE(shown - 1000, after - before);
}

TEST(FaultyTimeTest, ItRunsAtTheRateThatItIsGivenAndNeverSteps) {
    verifies("SWR-PRT-034", Technique::kBackToBack);
    FaultyTime sut{3U};
    expect_rate(sut, 0);
    for (const std::int64_t ppm : {100'000, -100'000, 0}) {
        const std::int64_t before = sut.read_ns();
        sut.set_rate(ppm);
        EXPECT_GE(sut.read_ns(), before);
        expect_rate(sut, ppm);
    }
}

TEST(FaultyTimeTest, OnlyTheNextSleepOfTheVictimIsHeld) {
    verifies("SWR-PRT-034", Technique::kFaultInjection);
    FaultyTime sut{0U};
    sut.set_victim(pthread_self());
    sut.hold_sleep(Duration{20'000'000});
    std::thread{[&sut] { sut.wait_until(sut.read_ns() + 1'000'000); }}.join();
    EXPECT_TRUE(sut.is_sleep_to_be_held());

    const std::int64_t until = sut.read_ns() + 1'000'000;
    sut.wait_until(until);
    EXPECT_GE(sut.read_ns(), until + 20'000'000);
    EXPECT_FALSE(sut.is_sleep_to_be_held());
}

TEST(FaultyTimeTest, OnlyTheNextDeadlineOfTheVictimComesLate) {
    verifies("SWR-PRT-034", Technique::kFaultInjection);
    FaultyTime sut{1U};
    sut.set_victim(pthread_self());
    sut.hold_deadline(Duration{700});
    std::thread{[&sut] { EXPECT_EQ(sut.to_monotonic(12'345), 12'345); }}.join();

    EXPECT_EQ(sut.to_monotonic(12'345), 12'345 + 700);
    EXPECT_EQ(sut.to_monotonic(12'345), 12'345);
    sut.set_rate(100'000);
    const std::int64_t shown = sut.read_ns();
    const std::int64_t real = get_monotonic_clock().read_ns();
    EXPECT_LE(sut.to_monotonic(shown + 11'000'000), real + 10'000'001);
}

TEST(InversionTest, TheMutexIsHeldFromItsPreparationToTheAttempt) {
    verifies("SWR-PRT-035", Technique::kFaultInjection);
    const FrameClock clock = FrameClock::starting_in(Duration{0});
    Inversion sut{clock, 0, ports::posix_rt::ThreadPlace::kAnyProcessor};
    EXPECT_TRUE(sut.get_mutex().try_lock());
    sut.get_mutex().unlock();

    sut.prepare();
    sut.prepare();
    while (!sut.is_prepared()) {
        std::this_thread::yield();
    }
    EXPECT_FALSE(sut.get_mutex().try_lock());
    sut.attempt(clock.get_now() + Duration{1'000'000});
    EXPECT_FALSE(sut.is_prepared());
    sut.get_mutex().lock();
    sut.get_mutex().unlock();
}

TEST(PageStormTest, TheMeterCountsThePageFaultsOfItsThread) {
    verifies("SWR-PRT-037", Technique::kBackToBack);
    constexpr std::size_t kPages = 100U;
    PageMeter sut;
    sut.look();
    void* const memory =
        mmap(nullptr, kPages * 4096U, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    ASSERT_NE(memory, MAP_FAILED);
    ASSERT_EQ(madvise(memory, kPages * 4096U, MADV_NOHUGEPAGE), 0);
    for (std::size_t i = 0U; i < kPages; ++i) {
        static_cast<volatile char*>(memory)[i * 4096U] = 1;
    }

    sut.look();
    EXPECT_GE(sut.get_minor(), static_cast<std::int64_t>(kPages));
    ASSERT_EQ(munmap(memory, kPages * 4096U), 0);
}

TEST(PageStormTest, LockedPagesAreFoundWhereTheKernelCountsThem) {
    verifies("SWR-PRT-037", Technique::kBackToBack);
    ASSERT_EQ(munlockall(), 0);
    EXPECT_FALSE(has_locked_pages());
}

TEST(PageStormTest, ItBlowsUntilItIsStopped) {
    verifies("SWR-PRT-037", Technique::kFaultInjection);
    PageStorm none{0U};
    EXPECT_FALSE(none.is_under_way());
    EXPECT_FALSE(none.stop());
    PageStorm sut{60U};
    EXPECT_TRUE(sut.is_under_way());
    EXPECT_TRUE(sut.stop());
    EXPECT_FALSE(sut.is_under_way());
    EXPECT_FALSE(sut.stop());
}

}  // namespace
}  // namespace mamori::time_faults
