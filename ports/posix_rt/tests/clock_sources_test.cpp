// SPDX-License-Identifier: Apache-2.0
// Goal: the checks of the safety layer read the clocks of Linux and find a time line with a rate other than
// that of the reference. Method: the real clocks compared with each other; a stopped time line, and one that
// is 10 % too fast or too slow, derived from the real clock.
#include "mamori/ports/posix_rt/clock_sources.hpp"

#include <gtest/gtest.h>

#include "mamori/safety/assumptions/assumption_checks.hpp"
#include "mamori/trace/verifies.hpp"
#include "support/fake_clock.hpp"

namespace mamori::ports::posix_rt {
namespace {

using safety::SelfTestStatus;
using safety::TickSourceCheck;
using namespace verification;

/// The Linux clock at `percent` of its rate.
class ScaledClock final : public TimeSource {
  public:
    explicit ScaledClock(std::int64_t percent) noexcept : percent_(percent) {}
    std::int64_t read_ns() const noexcept override {
        return (get_monotonic_clock().read_ns() - zero_) * percent_ / 100;
    }
    void wait_until(std::int64_t) const noexcept override {}
    std::int64_t to_monotonic(std::int64_t ns) const noexcept override { return ns; }

  private:
    std::int64_t percent_;
    std::int64_t zero_{get_monotonic_clock().read_ns()};
};

/// @return the first result other than "not known yet" of a check over windows of 50 ms.
SelfTestStatus check_window(safety::ClockSource& tick) {
    ReadingSource reference{get_raw_clock()};
    TickSourceCheck check{reference, tick, {50_ms, 20000U}};
    SelfTestStatus status = SelfTestStatus::kRunning;
    while (status == SelfTestStatus::kRunning) {
        status = check.check();
    }
    return status;
}

TEST(ClockSourcesTest, SourcesReturnTheReadingsOfTheirClocks) {
    verifies("SWR-SLF-021");
    FakeClock clock{7};
    ReadingSource reading{clock};
    EXPECT_EQ(reading.read(), Instant{7});
    clock.now_ns = 9;
    EXPECT_EQ(reading.read(), Instant{9});

    const FrameClock line = FrameClock::starting_in(3_ns, clock);
    TickSource tick{line};
    EXPECT_EQ(tick.read(), Instant{-3});
    clock.now_ns = 15;
    EXPECT_EQ(tick.read(), Instant{3});
}

TEST(ClockSourcesTest, TimeLineOfThisComputerKeepsItsRate) {
    verifies("SWR-SLF-021", Technique::kInterface);
    const FrameClock line = FrameClock::starting_in(0_ns);
    TickSource tick{line};

    // A delay of 1 ms between two readings is a deviation of 2 %. It does not occur ten times in succession.
    SelfTestStatus status = SelfTestStatus::kFailed;
    for (int i = 0; i < 10 && status != SelfTestStatus::kPassed; ++i) {
        status = check_window(tick);
    }
    EXPECT_EQ(status, SelfTestStatus::kPassed);
}

TEST(ClockSourcesTest, TimeLineThatIsStoppedOrDeviatesByTenPercentFails) {
    verifies("SWR-SLF-021", Technique::kFaultInjection, Polarity::kViolation);
    const FakeClock frozen{7};
    const FrameClock frozen_line = FrameClock::starting_in(0_ns, frozen);
    TickSource frozen_tick{frozen_line};
    EXPECT_EQ(check_window(frozen_tick), SelfTestStatus::kFailed);

    for (const std::int64_t percent : {90, 110}) {
        const ScaledClock scaled{percent};
        const FrameClock line = FrameClock::starting_in(0_ns, scaled);
        TickSource tick{line};
        EXPECT_EQ(check_window(tick), SelfTestStatus::kFailed) << percent;
    }
}

}  // namespace
}  // namespace mamori::ports::posix_rt
