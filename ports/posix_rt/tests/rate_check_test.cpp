// SPDX-License-Identifier: Apache-2.0
// Goal: a deviation above the limit is found in time and with its direction; a clock within the limit is
// never reported, for any uncertainty of the readings. Method: constructed readings on both sides of the
// limit.
#include "mamori/ports/posix_rt/rate_check.hpp"

#include <gtest/gtest.h>

#include <array>

#include "mamori/trace/verifies.hpp"
#include "support/fake_clock.hpp"

namespace mamori::ports::posix_rt {
namespace {

using namespace verification;
using literals::operator""_ms;
using literals::operator""_s;
using literals::operator""_us;

/// 0.5 % over 10 ms: 50 us.
constexpr RateLimits kLimits{10_ms, 5000};

/// Reading `us` after the first one (on the reference), with a gain of the watched clock of `gained_ns`.
ClockPair at(std::int64_t us, std::int64_t gained_ns, Duration uncertainty = {}) {
    return {Instant{us * 1000 + gained_ns}, 77'000'000 + us * 1000, uncertainty};
}

TEST(RateCheckTest, ClocksWithEqualRatesHaveNoFindingAndTheSpansAreCounted) {
    verifies("SWR-PRT-032");
    RateCheck sut{kLimits};

    for (std::int64_t us = 0; us <= 100'000; us += 250) {
        ASSERT_EQ(sut.look(at(us, 0)), Rate::kSound);
    }
    EXPECT_EQ(sut.get_sound_spans(), 10U);
}

TEST(RateCheckTest, AGainOrLossIsFoundJustBeyondThatOfASpanAtTheLimit) {
    verifies("SWR-PRT-032", Technique::kBoundaryValues, Polarity::kViolation);
    for (const std::int64_t sign : {1, -1}) {
        RateCheck sut{kLimits};
        ASSERT_EQ(sut.look(at(0, 0)), Rate::kSound);
        EXPECT_EQ(sut.look(at(3000, sign * 50'000)), Rate::kSound);
        EXPECT_EQ(sut.look(at(3250, sign * 50'001)), sign > 0 ? Rate::kFast : Rate::kSlow);
        EXPECT_EQ(sut.get_sound_spans(), 0U);
        EXPECT_EQ(sut.look(at(3500, sign * 90'000)), Rate::kSound) << "a new span begins here";
    }
}

TEST(RateCheckTest, ARateAtTheLimitIsNeverFoundAndOneBeyondItWithinTwoSpans) {
    verifies("SWR-PRT-032", Technique::kBoundaryValues, Polarity::kViolation);
    for (const std::int64_t phase_us : {0, 2500, 5000, 9750}) {
        for (const std::int64_t ppm : {5000, -5000, 5100, -5100, 100'000, -1'000'000}) {
            RateCheck sut{kLimits};
            std::int64_t found_us = -1;
            for (std::int64_t us = 0; us <= phase_us + 20'000 && found_us < 0; us += 250) {
                const std::int64_t since = us > phase_us ? us - phase_us : 0;
                if (sut.look(at(us, since * ppm / 1000)) != Rate::kSound) {
                    found_us = us;
                }
            }
            EXPECT_EQ(found_us >= 0, ppm > 5000 || ppm < -5000)
                << ppm << " ppm from " << phase_us << " us on";
        }
    }
}

TEST(RateCheckTest, AStoppedOrSteppedClockIsFoundAsSoonAsTheStepExceedsTheLimit) {
    verifies("SWR-PRT-032", Technique::kFaultInjection, Polarity::kViolation);
    RateCheck stopped{kLimits};
    ASSERT_EQ(stopped.look(at(0, 0)), Rate::kSound);
    EXPECT_EQ(stopped.look(at(50, -50'000)), Rate::kSound);
    EXPECT_EQ(stopped.look(at(51, -51'000)), Rate::kSlow);

    RateCheck stepped{kLimits};
    ASSERT_EQ(stepped.look(at(0, 0)), Rate::kSound);
    EXPECT_EQ(stepped.look(at(250, 3'600'000'000'000)), Rate::kFast);
}

TEST(RateCheckTest, TheUncertaintyCountsInFavourOfTheClock) {
    verifies("SWR-PRT-032", Technique::kBoundaryValues);
    RateCheck sut{kLimits};

    ASSERT_EQ(sut.look(at(0, 0, 2_us)), Rate::kSound);
    EXPECT_EQ(sut.look(at(1000, 55'000, 3_us)), Rate::kSound);
    EXPECT_EQ(sut.look(at(1250, 55'001, 3_us)), Rate::kFast);
}

TEST(RateCheckTest, TheLimitOfASpanCountsEachNanosecond) {
    verifies("SWR-PRT-032", Technique::kBoundaryValues, Polarity::kViolation);
    constexpr RateLimits kHalf{1500_us, 500'000};  // 750 us
    for (const std::int64_t gained_ns : {750'000, -750'000}) {
        RateCheck sut{kHalf};
        ASSERT_EQ(sut.look(at(0, 0)), Rate::kSound);
        EXPECT_EQ(sut.look(at(1000, gained_ns)), Rate::kSound);
        EXPECT_NE(sut.look(at(1250, gained_ns + (gained_ns > 0 ? 1 : -1))), Rate::kSound);
    }
}

TEST(RateCheckTest, TheUncertaintyCountsForALossLikewise) {
    verifies("SWR-PRT-032", Technique::kBoundaryValues);
    RateCheck sut{kLimits};
    ASSERT_EQ(sut.look(at(0, 0, 2_us)), Rate::kSound);
    EXPECT_EQ(sut.look(at(1000, -55'000, 3_us)), Rate::kSound);
    EXPECT_EQ(sut.look(at(1250, -55'001, 3_us)), Rate::kSlow);
}

TEST(RateCheckTest, AFindingDiscardsTheSpansBeforeIt) {
    verifies("SWR-PRT-033", Technique::kStateTransition, Polarity::kViolation);
    RateCheck sut{kLimits};
    for (const std::int64_t us : {0, 10'000, 20'000}) {
        ASSERT_EQ(sut.look(at(us, 0)), Rate::kSound);
    }
    EXPECT_EQ(sut.get_sound_spans(), 2U);
    ASSERT_EQ(sut.look(at(20'250, 50'001)), Rate::kFast);
    EXPECT_EQ(sut.get_sound_spans(), 0U);
}

TEST(RateCheckTest, ANanosecondHasADirection) {
    verifies("SWR-PRT-032", Technique::kBoundaryValues, Polarity::kViolation);
    for (const std::int64_t gained : {1, -1}) {
        RateCheck sut{{Duration{1000}, 1}};  // less than a nanosecond per span
        ASSERT_EQ(sut.look({Instant{0}, 0, {}}), Rate::kSound);
        EXPECT_EQ(sut.look({Instant{500 + gained}, 500, {}}), gained > 0 ? Rate::kFast : Rate::kSlow);
    }
}

TEST(RateCheckTest, ALateCallComparesOverTheElapsedTime) {
    verifies("SWR-PRT-032", Technique::kErrorGuessing);
    RateCheck sut{kLimits};

    ASSERT_EQ(sut.look(at(0, 0)), Rate::kSound);
    ASSERT_EQ(sut.look(at(1'000'000, 5'000'000)), Rate::kSound) << "0.5 % of a second";
    EXPECT_EQ(sut.look(at(3'000'000, 15'000'001)), Rate::kFast);
}

TEST(RateCheckTest, APairIsReadThreeTimesAndTheNarrowestCounts) {
    verifies("SWR-PRT-032", Technique::kBoundaryValues);
    /// Reads that take 30, 10 and 20 ns.
    class SlowReading final : public ClockReading {
      public:
        std::int64_t read_ns() const noexcept override {
            constexpr std::array<std::int64_t, 6U> kTimes{100, 130, 200, 210, 300, 320};
            ++count;
            return kTimes[(count - 1U) % kTimes.size()];
        }
        mutable std::size_t count{0U};
    } reference;
    FakeClock source{0};
    const ClockPair pair = read_pair(FrameClock::starting_in(Duration{0}, source), reference);

    EXPECT_EQ(reference.count, 6U);
    EXPECT_EQ(pair.reference_ns, 205);
    EXPECT_EQ(pair.uncertainty, Duration{6});
}

TEST(RateCheckTest, APairIsReadWithinItsUncertainty) {
    verifies("SWR-PRT-032", Technique::kInterface);
    const FrameClock clock = FrameClock::starting_in(1_s);

    const std::int64_t before = get_raw_clock().read_ns();
    const ClockPair pair = read_pair(clock, get_raw_clock());
    const std::int64_t after = get_raw_clock().read_ns();

    EXPECT_GE(pair.reference_ns, before);
    EXPECT_LE(pair.reference_ns, after);
    EXPECT_GT(pair.uncertainty.ns, 0);
    EXPECT_LT(pair.watched, Instant{0} + 3600_s);
}

}  // namespace
}  // namespace mamori::ports::posix_rt
