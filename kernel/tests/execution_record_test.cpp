// SPDX-License-Identifier: Apache-2.0
// Goal: a run is held against its limits on the whole time line, and no run hides another.
// Method: both sides of both limits, the ends of the time line, a clock that runs backwards, runs one after
// the other.
#include "mamori/kernel/component/execution_record.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <utility>

#include "mamori/trace/verifies.hpp"

namespace mamori {
namespace {

using namespace verification;

using literals::operator""_ns;

constexpr std::uint32_t kWithin = ExecutionRecord::kWithin;
constexpr std::uint32_t kOutside = ExecutionRecord::kOutside;
constexpr Instant kFirst{std::numeric_limits<std::int64_t>::min()};
constexpr Instant kLast{std::numeric_limits<std::int64_t>::max()};

/// What a record with these limits sees of one run.
std::uint32_t note(std::pair<Duration, Duration> limits, Instant started, Instant finished) {
    ExecutionRecord record{limits.first, limits.second};
    record.note_run(started, finished);
    return record.get_seen();
}

std::uint32_t note_unlimited(Instant started, Instant finished) {
    ExecutionRecord record;
    record.note_run(started, finished);
    return record.get_seen();
}

/// Each has a bit of its own, since both may be seen at once; supervision keeps them.
static_assert(kWithin == 1U && kOutside == 2U);

TEST(ExecutionRecordTest, ARunWithinItsLimitsIsNoted) {
    verifies("SWR-KRN-030", Technique::kBoundaryValues);
    const auto limits = std::make_pair(10_ns, 20_ns);

    EXPECT_EQ(ExecutionRecord(10_ns, 20_ns).get_seen(), 0U);
    EXPECT_EQ(note(limits, Instant{-5}, Instant{5}), kWithin);
    EXPECT_EQ(note(limits, Instant{0}, Instant{20}), kWithin);
    EXPECT_EQ(note(limits, kFirst, kFirst + 10_ns), kWithin);
    EXPECT_EQ(note(limits, kLast - 20_ns, kLast), kWithin);
}

TEST(ExecutionRecordTest, ARunOutsideItsLimitsIsNotedAsSuch) {
    verifies("SWR-KRN-030", Technique::kBoundaryValues, Polarity::kViolation);
    const auto limits = std::make_pair(10_ns, 20_ns);

    EXPECT_EQ(note(limits, Instant{-5}, Instant{4}), kOutside);
    EXPECT_EQ(note(limits, Instant{0}, Instant{21}), kOutside);
    EXPECT_EQ(note(limits, kFirst, kLast), kOutside);
    EXPECT_EQ(note(limits, Instant{0}, kLast), kOutside);
}

TEST(ExecutionRecordTest, AClockThatRanBackwardsIsOutsideHoweverFar) {
    verifies("SWR-KRN-030", Technique::kErrorGuessing, Polarity::kViolation);

    EXPECT_EQ(note_unlimited(Instant{1}, Instant{0}), kOutside);
    EXPECT_EQ(note_unlimited(Instant{0}, kFirst), kOutside);
    EXPECT_EQ(note_unlimited(kLast, kFirst), kOutside) << "the difference wraps to one nanosecond";
}

TEST(ExecutionRecordTest, WithoutLimitsEveryRunIsWithin) {
    verifies("SWR-KRN-030", Technique::kInterface);

    EXPECT_EQ(note_unlimited(Instant{0}, Instant{0}), kWithin);
    EXPECT_EQ(note_unlimited(Instant{0}, kLast), kWithin);
}

TEST(ExecutionRecordTest, NoRunHidesAnother) {
    verifies("SWR-KRN-030", Technique::kErrorGuessing, Polarity::kViolation);
    ExecutionRecord record{10_ns, 20_ns};

    record.note_run(Instant{0}, Instant{21});
    record.note_run(Instant{21}, Instant{31});
    EXPECT_EQ(record.take_seen(), kWithin | kOutside);
    EXPECT_EQ(record.get_seen(), 0U);
    record.note_run(Instant{31}, Instant{41});
    EXPECT_EQ(record.get_seen(), kWithin);
}

}  // namespace
}  // namespace mamori
