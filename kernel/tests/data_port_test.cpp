// SPDX-License-Identifier: Apache-2.0
// Goal: a written value is seen by others only when it was published or handed on, once, with its age.
// Method: one output and one input, moved by hand as the executive does it.
#include "mamori/kernel/dataflow/data_port.hpp"
#include "mamori/kernel/system/system.hpp"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <cstdint>

#include "mamori/kernel/dataflow/connection.hpp"
#include "mamori/trace/verifies.hpp"

namespace mamori::testing_support {
namespace {

/// A payload that asks for more than a port gives by itself.
struct alignas(128) Wide {
    std::array<double, 128> values{};
};

}  // namespace
}  // namespace mamori::testing_support

MAMORI_FIELDS(mamori::testing_support::Wide, values)

namespace mamori {
namespace {

using namespace verification;

class DataPortTest : public ::testing::Test {
  protected:
    std::uint64_t calc_hash() const {
        TraceHash hash;
        OutPort<std::int32_t>::hash_published(out_, hash);
        return hash.get_value();
    }

    OutPort<std::int32_t> out_{kNoOwner, "out"};
    InPort<std::int32_t> in_{kNoOwner, "in"};
};

TEST_F(DataPortTest, AnOutputHasNothingToPublishBeforeTheFirstWrite) {
    verifies("SWR-KRN-015", Technique::kBoundaryValues, Polarity::kViolation);

    EXPECT_FALSE(out_.is_staged());
    EXPECT_FALSE(out_.publish(Instant{100}));

    EXPECT_EQ(out_.get_sequence(), 0U);
    EXPECT_EQ(out_.get_published_revision(), 0U);
    EXPECT_EQ(out_.get_published(), 0) << "value-initialised";
    EXPECT_EQ(out_.get_staged_sample(Instant{100}).revision, 0U) << "nothing to hand on either";
}

TEST_F(DataPortTest, WritesAreNumberedFromOneOnWhetherTheyArePublishedOrNot) {
    verifies("SWR-KRN-015", Technique::kBoundaryValues);

    out_.write(5);
    EXPECT_EQ(out_.get_staged_sample(Instant{50}).revision, 1U);
    ASSERT_TRUE(out_.publish(Instant{100}));
    EXPECT_EQ(out_.get_published_revision(), 1U);
    out_.write(6);
    out_.discard();
    out_.write(7);
    EXPECT_EQ(out_.get_published_revision(), 1U) << "not published yet";
    ASSERT_TRUE(out_.publish(Instant{200}));

    EXPECT_EQ(out_.get_published_revision(), 3U);
    EXPECT_EQ(out_.get_sequence(), 2U);
}

TEST_F(DataPortTest, AWriteNeverTouchesWhatIsPublished) {
    verifies("SWR-KRN-015", Technique::kStateTransition, Polarity::kViolation);

    for (std::int32_t i = 1; i <= 5; ++i) {
        out_.write(-i);
        out_.write(i);
        EXPECT_EQ(out_.get_published(), i - 1) << "still the value of the cycle before";
        EXPECT_EQ(out_.get_staged_sample(Instant{i}).value, i);
        ASSERT_TRUE(out_.publish(Instant{i}));
        EXPECT_EQ(out_.get_published(), i);
    }
}

TEST_F(DataPortTest, AWrittenValueIsPublishedAtItsInstant) {
    verifies("SWR-KRN-015");

    out_.write(5);
    EXPECT_TRUE(out_.is_staged());
    EXPECT_TRUE(out_.publish(Instant{100}));

    EXPECT_EQ(out_.get_published(), 5);
    EXPECT_EQ(out_.get_sequence(), 1U);
    EXPECT_FALSE(out_.is_staged());
    EXPECT_STREQ(out_.get_name(), "out");
}

TEST_F(DataPortTest, TheLastOfSeveralWritesCounts) {
    verifies("SWR-KRN-015", Technique::kEquivalenceClasses);

    out_.write(5);
    out_.write(6);
    EXPECT_TRUE(out_.publish(Instant{100}));

    EXPECT_EQ(out_.get_published(), 6);
    EXPECT_EQ(out_.get_sequence(), 1U) << "one publication";
}

TEST_F(DataPortTest, AValueThatIsNotPublishedYetIsNotSeen) {
    verifies("SWR-KRN-015", Technique::kErrorGuessing, Polarity::kViolation);
    out_.write(5);
    ASSERT_TRUE(out_.publish(Instant{100}));
    out_.write(6);

    in_.take(out_.get_published_sample());

    EXPECT_EQ(in_.read(), 5);
    EXPECT_EQ(out_.get_published(), 5);
}

TEST_F(DataPortTest, ADiscardedValueIsNeverPublished) {
    verifies("SWR-KRN-015", Technique::kFaultInjection, Polarity::kViolation);
    out_.write(5);
    ASSERT_TRUE(out_.publish(Instant{100}));
    out_.write(6);
    const std::uint64_t before = calc_hash();

    out_.discard();

    EXPECT_FALSE(out_.publish(Instant{200}));
    EXPECT_EQ(out_.get_published(), 5);
    EXPECT_EQ(out_.get_sequence(), 1U);
    EXPECT_EQ(calc_hash(), before);
}

TEST_F(DataPortTest, TheHashCoversValueSequenceAndInstant) {
    verifies("SWR-KRN-015", Technique::kErrorGuessing);
    OutPort<std::int32_t> other{kNoOwner, "other"};
    const auto hash_other = [&other] {
        TraceHash hash;
        OutPort<std::int32_t>::hash_published(other, hash);
        return hash.get_value();
    };
    out_.write(5);
    ASSERT_TRUE(out_.publish(Instant{100}));

    other.write(5);
    ASSERT_TRUE(other.publish(Instant{101}));
    EXPECT_NE(hash_other(), calc_hash()) << "instant";
    other.write(5);
    ASSERT_TRUE(other.publish(Instant{100}));
    EXPECT_NE(hash_other(), calc_hash()) << "sequence";
    out_.write(5);
    ASSERT_TRUE(out_.publish(Instant{100}));
    EXPECT_EQ(hash_other(), calc_hash());
    out_.write(6);
    other.write(7);
    ASSERT_TRUE(out_.publish(Instant{100}) && other.publish(Instant{100}));
    EXPECT_NE(hash_other(), calc_hash()) << "value";
}

TEST_F(DataPortTest, AnInputHasNoValueUntilOneArrives) {
    verifies("SWR-KRN-016");

    in_.take(out_.get_published_sample());

    EXPECT_FALSE(in_.has_value());
    EXPECT_FALSE(in_.is_new());
    EXPECT_EQ(in_.read(), 0) << "value-initialised";
    EXPECT_STREQ(in_.get_name(), "in");
}

TEST_F(DataPortTest, AnInputThatKeepsTheLatestValueCountsNothing) {
    verifies("SWR-KRN-016", Technique::kInterface);

    const PortCounts counts = count_latest(in_);

    EXPECT_EQ(counts.capacity, 0U);
    EXPECT_EQ(counts.high_water_mark, 0U);
    EXPECT_EQ(counts.rejected, 0U);
    EXPECT_EQ(counts.overwritten, 0U);
    EXPECT_EQ(counts.empty_reads, 0U);
}

TEST_F(DataPortTest, ValuesThatOneSourceLostAreNotCountedAmongThoseOfTheNext) {
    verifies("SWR-KRN-054", Technique::kStateTransition);
    in_.restart(kBeforeAll, 4U);
    in_.take({50, 5U, Instant{1}});
    in_.note_discarded(2U, 7U);
    EXPECT_EQ(in_.get_latest_counts().lost, 2U);

    in_.restart(Instant{2}, 3U);  // another source, whose revision passes the one held before
    in_.take({40, 4U, Instant{3}});
    in_.take({50, 5U, Instant{4}});

    EXPECT_EQ(in_.get_latest_counts().received, 3U);
    EXPECT_EQ(in_.get_latest_counts().superseded, 0U);
    EXPECT_EQ(in_.get_latest_counts().lost, 2U);
}

TEST_F(DataPortTest, ALatchedValueIsNewOnceAndGrowsOld) {
    verifies("SWR-KRN-016");
    out_.write(5);
    ASSERT_TRUE(out_.publish(Instant{100}));

    in_.take(out_.get_published_sample());
    EXPECT_TRUE(in_.has_value() && in_.is_new());
    EXPECT_EQ(in_.read(), 5);
    EXPECT_EQ(in_.calc_age(Instant{100}), 0_ns);
    in_.mark_read();
    in_.take(out_.get_published_sample());

    EXPECT_FALSE(in_.is_new()) << "the same publication is not new again";
    EXPECT_TRUE(in_.has_value());
    EXPECT_EQ(in_.calc_age(Instant{350}), 250_ns);
}

/// Has two inputs and an output, which feeds them.
class Reader final : public Component {
  public:
    Reader() noexcept : Component("reader") {}
    OutPort<int> out{*this, "out"};
    InPort<int> first{*this, "first"};
    InPort<int> second{*this, "second"};
    void publish(int value) noexcept {
        out.write(value);
        static_cast<void>(out.publish(Instant{}));
    }
};

TEST(DataPortOwnerTest, TheEndOfAPassMakesTheInputsOfItsOwnerReadAndNoOthers) {
    verifies("SWR-KRN-016", Technique::kStateTransition);
    Reader owner;
    Reader other;
    owner.publish(1);
    owner.first.take(owner.out.get_published_sample());
    owner.second.take(owner.out.get_published_sample());
    other.first.take(owner.out.get_published_sample());
    EXPECT_TRUE(owner.first.is_new() && owner.second.is_new() && other.first.is_new());

    owner.end_read_pass();
    EXPECT_FALSE(owner.first.is_new() || owner.second.is_new());
    EXPECT_TRUE(owner.first.has_value() && owner.second.has_value());
    EXPECT_TRUE(other.first.is_new());

    owner.publish(2);
    owner.second.take(owner.out.get_published_sample());
    EXPECT_FALSE(owner.first.is_new());
    EXPECT_TRUE(owner.second.is_new());
}

TEST_F(DataPortTest, AnEqualValueThatIsPublishedAgainIsNew) {
    verifies("SWR-KRN-016", Technique::kEquivalenceClasses);
    out_.write(5);
    ASSERT_TRUE(out_.publish(Instant{100}));
    in_.take(out_.get_published_sample());
    in_.mark_read();

    out_.write(5);
    ASSERT_TRUE(out_.publish(Instant{200}));
    in_.take(out_.get_published_sample());

    EXPECT_TRUE(in_.is_new());
    EXPECT_EQ(in_.calc_age(Instant{200}), 0_ns);
}

TEST_F(DataPortTest, AHandedOnValueIsTakenAheadOfItsPublicationAndNotTwice) {
    verifies("SWR-KRN-016");
    out_.write(5);

    in_.take(out_.get_staged_sample(Instant{50}));
    EXPECT_TRUE(in_.is_new());
    EXPECT_EQ(in_.read(), 5);
    EXPECT_EQ(in_.calc_age(Instant{50}), 0_ns);
    in_.mark_read();
    in_.take(out_.get_staged_sample(Instant{60}));
    EXPECT_FALSE(in_.is_new()) << "handed on again without a write";
    ASSERT_TRUE(out_.publish(Instant{100}));
    in_.take(out_.get_published_sample());

    EXPECT_FALSE(in_.is_new()) << "its publication is nothing new";
}

TEST_F(DataPortTest, AWriteAfterTheHandOnArrivesWithThePublication) {
    verifies("SWR-KRN-016", Technique::kErrorGuessing);
    out_.write(5);
    in_.take(out_.get_staged_sample(Instant{50}));
    in_.mark_read();

    out_.write(6);
    ASSERT_TRUE(out_.publish(Instant{100}));
    in_.take(out_.get_published_sample());

    EXPECT_TRUE(in_.is_new());
    EXPECT_EQ(in_.read(), 6);
}

TEST_F(DataPortTest, AnOlderPublicationDoesNotReplaceAHandedOnValueThatWasDiscardedAtItsSource) {
    verifies("SWR-KRN-016", Technique::kErrorGuessing);
    out_.write(5);
    ASSERT_TRUE(out_.publish(Instant{100}));
    out_.write(6);
    in_.take(out_.get_staged_sample(Instant{150}));
    in_.mark_read();
    out_.discard();

    in_.take(out_.get_published_sample());

    EXPECT_EQ(in_.read(), 6);
    EXPECT_FALSE(in_.is_new());
}

TEST_F(DataPortTest, NothingIsHandedOnWhenNothingWasWritten) {
    verifies("SWR-KRN-016", Technique::kBoundaryValues);
    out_.write(5);
    ASSERT_TRUE(out_.publish(Instant{100}));

    in_.take(out_.get_staged_sample(Instant{150}));

    EXPECT_FALSE(in_.has_value());
}

TEST_F(DataPortTest, AValueIsTooOldOnceItIsOlderThanTheLimit) {
    verifies("SWR-KRN-016", Technique::kBoundaryValues, Polarity::kViolation);
    static constexpr AgeLimits kLimits{Duration{50}, {}};
    in_.set_age_limits(kLimits);
    EXPECT_EQ(in_.calc_status(Instant{0}), PortStatus::kBufferEmpty);
    out_.write(5);
    ASSERT_TRUE(out_.publish(Instant{100}));
    in_.take(out_.get_published_sample());

    EXPECT_EQ(in_.calc_status(Instant{150}), PortStatus::kOk);
    EXPECT_EQ(in_.calc_status(Instant{151}), PortStatus::kBufferTimeout);
}

TEST_F(DataPortTest, AValueOfAnInstantToComeIsNotFresh) {
    verifies("SWR-KRN-040", Technique::kBoundaryValues, Polarity::kViolation);
    out_.write(5);
    ASSERT_TRUE(out_.publish(Instant{100}));
    in_.take(out_.get_published_sample());

    EXPECT_EQ(in_.calc_status(Instant{100}), PortStatus::kOk);
    EXPECT_EQ(in_.calc_status(Instant{99}), PortStatus::kBufferTimeout) << "also without an age limit";
    static constexpr AgeLimits kLimits{Duration{50}, Duration{7}};
    in_.set_age_limits(kLimits);
    EXPECT_EQ(in_.calc_status(Instant{93}), PortStatus::kOk);
    EXPECT_EQ(in_.calc_status(Instant{92}), PortStatus::kBufferTimeout);
}

TEST_F(DataPortTest, TheToleranceOfAConnectionReachesItsRow) {
    verifies("SWR-KRN-040");
    const auto part = connect(out_, in_, fresh_within(Duration{50}, Duration{7}));
    EXPECT_EQ(part.row.age_max, Duration{50});
    EXPECT_EQ(part.row.lead_max, Duration{7});
    EXPECT_EQ(connect(out_, in_, fresh_within(Duration{50})).row.lead_max, Duration{0});
}

TEST_F(DataPortTest, ACrossingThatNothingWentThroughBringsNoValue) {
    verifies("SWR-KRN-016", Technique::kBoundaryValues, Polarity::kViolation);
    Crossing<std::int32_t> crossing;

    crossing.latch(in_, Instant{0});
    EXPECT_FALSE(in_.has_value());

    out_.write(5);
    ASSERT_TRUE(out_.publish(Instant{100}));
    crossing.deliver(out_);
    crossing.latch(in_, Instant{99});
    EXPECT_FALSE(in_.has_value()) << "published after the opening";
    crossing.latch(in_, Instant{100});
    EXPECT_TRUE(in_.has_value());
}

TEST_F(DataPortTest, ACrossingBringsNothingThatWasPublishedUpToARestart) {
    verifies("SWR-MOD-009", Technique::kBoundaryValues, Polarity::kViolation);
    Crossing<std::int32_t> crossing;
    in_.restart(Instant{100}, 0U);
    EXPECT_EQ(in_.get_restart_count(), 1U);
    out_.write(5);
    ASSERT_TRUE(out_.publish(Instant{100}));
    crossing.deliver(out_);

    crossing.latch(in_, Instant{200});
    EXPECT_FALSE(in_.has_value()) << "at the very instant: the window before the switch closed then";
    out_.write(6);
    ASSERT_TRUE(out_.publish(Instant{101}));
    crossing.deliver(out_);
    crossing.latch(in_, Instant{200});
    EXPECT_TRUE(in_.has_value());
}

TEST_F(DataPortTest, AClearedCrossingHoldsNoneOfTheThreeValuesThatItCanHold) {
    verifies("SWR-KRN-039", Technique::kBoundaryValues);
    Crossing<std::int32_t> crossing;
    for (const std::int64_t published_at : {100, 200, 300}) {
        out_.write(5);
        ASSERT_TRUE(out_.publish(Instant{published_at}));
        crossing.deliver(out_);
        crossing.latch(in_, Instant{0});  // holds the first value for a later window
    }

    crossing.clear(in_);
    crossing.latch(in_, Instant{1000});

    EXPECT_FALSE(in_.has_value());
    EXPECT_EQ(in_.get_missed_count(), 0U);
}

/// A word whose exchange always fails, as if the writer replaced each entry in between.
struct OvertakenWord : std::atomic<std::uint32_t> {
    using std::atomic<std::uint32_t>::atomic;
    bool compare_exchange_strong(std::uint32_t&, std::uint32_t, std::memory_order,
                                 std::memory_order) noexcept {
        return false;
    }
};

TEST_F(DataPortTest, ACrossingCountsAWindowStartAtWhichTheWriterIsFasterInEachAttempt) {
    verifies("SWR-KRN-052", Technique::kFaultInjection, Polarity::kViolation);
    Crossing<std::int32_t, OvertakenWord> crossing;
    crossing.latch(in_, Instant{0});
    EXPECT_EQ(in_.get_missed_count(), 0U) << "nothing was delivered yet";
    for (const std::int64_t published_at : {100, 200}) {
        out_.write(5);
        ASSERT_TRUE(out_.publish(Instant{published_at}));
        crossing.deliver(out_);
    }

    crossing.latch(in_, Instant{200});

    EXPECT_FALSE(in_.has_value());
    EXPECT_EQ(in_.get_missed_count(), 1U);
}

TEST(ConnectionOperationsTest, ARowThatConnectDidNotMakePromisesNothing) {
    verifies("SWR-KRN-026", Technique::kInterface, Polarity::kViolation);
    constexpr ConnectionOperations kNone;

    static_assert(!kNone.is_set && !kNone.may_leave_core && !kNone.is_latest);
    EXPECT_TRUE(kNone.deliver == nullptr && kNone.latch == nullptr && kNone.hand_on == nullptr);
}

TEST(PortAlignmentTest, PayloadsFromOneKibibyteOnBeginWithACacheLineAndSmallerOnesTakeNoPadding) {
    verifies("SWR-KRN-015", Technique::kBoundaryValues);
    using Large = std::array<double, 128>;
    using Odd = std::array<double, 129>;
    using Small = std::array<double, 127>;

    static_assert(alignof(OutPort<Small>) == alignof(double) && alignof(InPort<Small>) == alignof(double));
    static_assert(alignof(OutPort<Large>) == 64U && alignof(InPort<Large>) == 64U);
    static_assert(alignof(OutPort<testing_support::Wide>) == 128U, "a type's own alignment is kept");
    OutPort<Odd> out{kNoOwner, "out"};
    InPort<Odd> in{kNoOwner, "in"};
    out.write(Odd{1.0});
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(&out.get_published()) % 64U, 0U);
    ASSERT_TRUE(out.publish(Instant{100}));
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(&out.get_published()) % 64U, 0U);
    in.take(out.get_published_sample());

    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(&in.read()) % 64U, 0U);
    EXPECT_EQ(in.read(), Odd{1.0});
}

TEST(PortStatusTest, NumbersAreThoseOfTheStandard) {
    verifies("SWR-KRN-016", Technique::kInterface);

    EXPECT_EQ(static_cast<std::uint32_t>(PortStatus::kOk), 0U);
    EXPECT_EQ(static_cast<std::uint32_t>(PortStatus::kBufferFull), 2U);
    EXPECT_EQ(static_cast<std::uint32_t>(PortStatus::kBufferEmpty), 3U);
    EXPECT_EQ(static_cast<std::uint32_t>(PortStatus::kBufferTimeout), 4U);
}

TEST(PortNeedTest, AnInputIsMandatoryUnlessItSaysOtherwise) {
    verifies("SWR-KRN-016", Technique::kInterface);

    static_assert(InPort<double>::kIsMandatory);
    static_assert(!InPort<double, Need::kOptional>::kIsMandatory);
    static_assert(std::is_same_v<OutPort<double>::Payload, double>);
    SUCCEED();
}

}  // namespace
}  // namespace mamori
