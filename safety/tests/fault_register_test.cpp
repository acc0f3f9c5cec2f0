// SPDX-License-Identifier: Apache-2.0
// Goal: a fault is confirmed over its cycles, latched with its first occurrence, and cleared only by a
// deliberate acknowledgement after it is gone. Method: both sides of each limit, each status, full storage.
#include "mamori/safety/reaction/fault_register.hpp"

#include <limits>
#include <vector>

#include "mamori/trace/verifies.hpp"
#include "mamori/verification/failed_check.hpp"
#include "support/fault_register_fixture.hpp"

namespace mamori::safety {
namespace {

using namespace verification;

using FaultRegisterTest = testing_support::FaultRegisterFixture;

TEST_F(FaultRegisterTest, FaultIsLatchedInTheCycleInWhichItIsConfirmed) {
    verifies("SWR-FLT-001", Technique::kBoundaryValues);
    ASSERT_EQ(sut_.set_confirmation(1U, {3U}), Status::kOk);
    report(1U, true);
    report(1U, true);
    EXPECT_FALSE(sut_.is_latched(1U));

    report(1U, true);
    EXPECT_TRUE(sut_.is_latched(1U));
    EXPECT_EQ(sut_.get_first(), 1U);
}

TEST_F(FaultRegisterTest, FaultThatIsGoneBeforeItsConfirmationIsNotLatched) {
    verifies("SWR-FLT-001", Technique::kBoundaryValues, Polarity::kViolation);
    ASSERT_EQ(sut_.set_confirmation(1U, {3U}), Status::kOk);

    for (int i = 0; i < 100; ++i) {
        report(1U, true);
        report(1U, true);
        report(1U, false);
    }
    EXPECT_FALSE(sut_.is_latched(1U));
    EXPECT_EQ(sut_.get_first(), kNoFault);
    EXPECT_EQ(sut_.get_latched_count(), 0U);
}

TEST_F(FaultRegisterTest, FaultWithoutASetConfirmationIsLatchedAtOnce) {
    verifies("SWR-FLT-001", Technique::kEquivalenceClasses, Polarity::kViolation);

    report(3U, true);
    EXPECT_TRUE(sut_.is_latched(3U));
}

TEST_F(FaultRegisterTest, RecordThatNobodyWroteKnowsOfNoFault) {
    verifies("SWR-FLT-001", Technique::kInterface);
    constexpr FaultRecord kFresh{};

    EXPECT_EQ(kFresh.confirmation.cycles, 1U) << "the severest: at once";
    EXPECT_EQ(kFresh.confirmation.decay, 0U);
    EXPECT_EQ(kFresh.confirmation.time, Duration{0});
    EXPECT_EQ(kFresh.healing.cycles, 1U);
    EXPECT_EQ(kFresh.healing.time, Duration{0});
    EXPECT_EQ(kFresh.count + kFresh.absent_cycles + kFresh.occurrences + kFresh.order, 0U);
    EXPECT_FALSE(kFresh.is_present || kFresh.is_confirmed || kFresh.is_latched);
}

TEST_F(FaultRegisterTest, ConfirmationIsRefusedOutOfRangeAndWhileTheFaultIsPresentOrLatched) {
    verifies("SWR-FLT-001", Technique::kInterface, Polarity::kViolation);

    EXPECT_EQ(sut_.set_confirmation(4U, {1U}), Status::kBadParameter);
    EXPECT_EQ(sut_.set_confirmation(0U, {0U}), Status::kBadParameter);
    ASSERT_EQ(sut_.set_confirmation(0U, {2U}), Status::kOk);
    report(0U, true);
    EXPECT_EQ(sut_.set_confirmation(0U, {9U}), Status::kPreconditionNotMet) << "present";
    report(0U, true);
    report(0U, false);
    EXPECT_EQ(sut_.set_confirmation(0U, {9U}), Status::kPreconditionNotMet) << "latched";
}

TEST_F(FaultRegisterTest, FaultBeyondTheRegisterGoesToTheAssertionHandler) {
    verifies("SWR-FLT-001", Technique::kErrorGuessing, Polarity::kViolation);

    EXPECT_CHECK_FAILS(sut_.report(4U, true, Instant{}), "span.hpp", 1);
}

TEST_F(FaultRegisterTest, StorageOutsideItsSizesGoesToTheAssertionHandler) {
    verifies("SWR-FLT-001", Technique::kBoundaryValues, Polarity::kViolation);

    std::vector<FaultRecord> records(65536U);
    EXPECT_CHECK_FAILS(FaultRegister{Span<FaultRecord>{}}, "fault_register.hpp", 1);
    EXPECT_CHECK_FAILS((FaultRegister{Span<FaultRecord>{records.data(), 65536U}}), "fault_register.hpp", 1);
    EXPECT_EQ((FaultRegister{Span<FaultRecord>{records.data(), 65535U}}.get_capacity()), 65535U);
}

TEST_F(FaultRegisterTest, OccurrencesAreHeldAtTheLargestNumber) {
    verifies("SWR-FLT-001", Technique::kBoundaryValues);
    constexpr std::uint32_t kMost = std::numeric_limits<std::uint32_t>::max();
    records_[2U].occurrences = kMost - 1U;

    for (int i = 0; i < 2; ++i) {
        report(2U, true);
        EXPECT_EQ(sut_.get_record(2U).occurrences, kMost);
        report(2U, false);
        ASSERT_EQ(sut_.acknowledge(2U), Status::kOk);
    }
}

TEST_F(FaultRegisterTest, LatchedFaultKeepsTheInstantsOfItsFirstOccurrence) {
    verifies("SWR-FLT-002");
    ASSERT_EQ(sut_.set_confirmation(0U, {2U}), Status::kOk);
    report(0U, false);
    report(0U, true);
    report(0U, true);
    EXPECT_EQ(sut_.get_record(0U).seen_at, Instant{20});
    EXPECT_EQ(sut_.get_record(0U).latched_at, Instant{30});

    report(0U, false);
    report(0U, true);
    report(0U, true);
    report(0U, true);
    EXPECT_EQ(sut_.get_record(0U).seen_at, Instant{20});
    EXPECT_EQ(sut_.get_record(0U).latched_at, Instant{30});
    EXPECT_EQ(sut_.get_record(0U).occurrences, 2U) << "a fault that stays is one occurrence";
    EXPECT_EQ(sut_.get_latched_count(), 1U);
}

TEST_F(FaultRegisterTest, LatchedFaultDoesNotHealByItself) {
    verifies("SWR-FLT-002", Technique::kFaultInjection, Polarity::kViolation);
    report(2U, true);

    for (int i = 0; i < 1000; ++i) {
        report(2U, false);
        ASSERT_TRUE(sut_.is_latched(2U));
    }
    EXPECT_FALSE(sut_.is_present(2U));
}

TEST_F(FaultRegisterTest, FirstFaultIsTheOneLatchedFirstWhateverItsNumber) {
    verifies("SWR-FLT-002", Technique::kStateTransition, Polarity::kViolation);
    report(3U, true);
    report(0U, true);
    report(1U, true);
    report(2U, true);
    EXPECT_EQ(sut_.get_latched_count(), sut_.get_capacity());
    EXPECT_EQ(sut_.get_first(), 3U);

    report(3U, false);
    ASSERT_EQ(sut_.acknowledge(3U), Status::kOk);
    EXPECT_EQ(sut_.get_first(), 0U);
    report(3U, true);
    EXPECT_EQ(sut_.get_first(), 0U) << "a fault that comes back is the last one";
}

TEST_F(FaultRegisterTest, OrderSurvivesTheAcknowledgementOfAllButOne) {
    verifies("SWR-FLT-002", Technique::kErrorGuessing, Polarity::kViolation);
    report(3U, true);
    report(2U, true);
    report(3U, false);
    ASSERT_EQ(sut_.acknowledge(3U), Status::kOk);

    report(0U, true);
    EXPECT_EQ(sut_.get_first(), 2U);
}

TEST_F(FaultRegisterTest, AcknowledgedFaultIsClearedOnceItIsGone) {
    verifies("SWR-FLT-003");
    report(0U, true);
    report(0U, false);

    EXPECT_EQ(sut_.acknowledge(0U), Status::kOk);
    EXPECT_FALSE(sut_.is_latched(0U));
    EXPECT_EQ(sut_.get_record(0U).order, 0U);
    EXPECT_EQ(sut_.get_first(), kNoFault);
    report(0U, true);
    EXPECT_TRUE(sut_.is_latched(0U)) << "it is latched again when it comes back";
    EXPECT_EQ(sut_.get_record(0U).latched_at, now_);
}

TEST_F(FaultRegisterTest, FaultThatIsStillPresentCannotBeAcknowledged) {
    verifies("SWR-FLT-003", Technique::kFaultInjection, Polarity::kViolation);
    report(0U, true);

    EXPECT_EQ(sut_.acknowledge(0U), Status::kPreconditionNotMet);
    EXPECT_EQ(sut_.acknowledge_all(), Status::kPreconditionNotMet);
    EXPECT_TRUE(sut_.is_latched(0U));
    EXPECT_EQ(sut_.acknowledge(1U), Status::kPreconditionNotMet) << "not latched";
    EXPECT_EQ(sut_.acknowledge(4U), Status::kBadParameter);
}

TEST_F(FaultRegisterTest, FaultThatReappearsUnconfirmedStillBlocksItsAcknowledgement) {
    verifies("SWR-FLT-003", Technique::kErrorGuessing, Polarity::kViolation);
    ASSERT_EQ(sut_.set_confirmation(0U, {3U}), Status::kOk);
    report(0U, true);
    report(0U, true);
    report(0U, true);
    report(0U, false);
    report(0U, true);

    EXPECT_EQ(sut_.acknowledge(0U), Status::kPreconditionNotMet);
}

TEST_F(FaultRegisterTest, AcknowledgingAllLeavesOnlyThoseThatArePresent) {
    verifies("SWR-FLT-003", Technique::kEquivalenceClasses);
    EXPECT_EQ(sut_.acknowledge_all(), Status::kOk) << "nothing to do";
    report(0U, true);
    report(1U, true);
    report(0U, false);

    EXPECT_EQ(sut_.acknowledge_all(), Status::kPreconditionNotMet);
    EXPECT_FALSE(sut_.is_latched(0U));
    EXPECT_TRUE(sut_.is_latched(1U));
    report(1U, false);
    EXPECT_EQ(sut_.acknowledge_all(), Status::kOk);
    EXPECT_EQ(sut_.get_latched_count(), 0U);
}

TEST_F(FaultRegisterTest, OrderBeginsAnewWhenNothingIsLatched) {
    verifies("SWR-FLT-002", Technique::kStateTransition);

    for (int i = 0; i < 3; ++i) {
        report(1U, true);
        report(2U, true);
        EXPECT_EQ(sut_.get_record(1U).order, 1U);
        EXPECT_EQ(sut_.get_record(2U).order, 2U);
        report(1U, false);
        report(2U, false);
        ASSERT_EQ(sut_.acknowledge_all(), Status::kOk);
    }
}

// ---- Healing ----

TEST_F(FaultRegisterTest, FaultIsAcknowledgedWhenItHasBeenGoneForItsCyclesOnly) {
    verifies("SWR-FLT-009", Technique::kBoundaryValues);
    ASSERT_EQ(sut_.set_healing(0U, {3U, Duration{0}}), Status::kOk);
    report(0U, true);

    report(0U, false);
    report(0U, false);
    EXPECT_EQ(sut_.acknowledge(0U), Status::kPreconditionNotMet);
    EXPECT_EQ(sut_.acknowledge_all(), Status::kPreconditionNotMet);
    report(0U, false);
    EXPECT_EQ(sut_.acknowledge(0U), Status::kOk);
}

TEST_F(FaultRegisterTest, FaultIsAcknowledgedWhenItHasBeenGoneForItsTimeOnly) {
    verifies("SWR-FLT-009", Technique::kBoundaryValues);
    ASSERT_EQ(sut_.set_healing(0U, {1U, Duration{100}}), Status::kOk);
    sut_.report(0U, true, Instant{0});

    sut_.report(0U, false, Instant{5});
    sut_.report(0U, false, Instant{104});
    EXPECT_EQ(sut_.acknowledge(0U), Status::kPreconditionNotMet);
    sut_.report(0U, false, Instant{105});
    EXPECT_EQ(sut_.acknowledge(0U), Status::kOk);
}

TEST_F(FaultRegisterTest, FaultThatComesBackBeginsItsHealingAnew) {
    verifies("SWR-FLT-009", Technique::kStateTransition, Polarity::kViolation);
    ASSERT_EQ(sut_.set_confirmation(0U, {2U}), Status::kOk);
    ASSERT_EQ(sut_.set_healing(0U, {2U, Duration{100}}), Status::kOk);
    sut_.report(0U, true, Instant{0});
    sut_.report(0U, true, Instant{10});

    sut_.report(0U, false, Instant{20});
    sut_.report(0U, true, Instant{119});  // not confirmed, and yet it was there
    sut_.report(0U, false, Instant{120});
    EXPECT_EQ(sut_.acknowledge(0U), Status::kPreconditionNotMet);
    sut_.report(0U, false, Instant{219});
    EXPECT_EQ(sut_.acknowledge(0U), Status::kPreconditionNotMet);
    sut_.report(0U, false, Instant{220});
    EXPECT_EQ(sut_.acknowledge(0U), Status::kOk);
}

TEST_F(FaultRegisterTest, ClockThatRunsBackwardsLetsNothingHeal) {
    verifies("SWR-FLT-009", Technique::kFaultInjection, Polarity::kViolation);
    ASSERT_EQ(sut_.set_healing(0U, {3U, Duration{100}}), Status::kOk);
    sut_.report(0U, true, Instant{0});
    sut_.report(0U, false, Instant{100});
    sut_.report(0U, false, Instant{190});
    sut_.report(0U, false, Instant{110});

    sut_.report(0U, false, Instant{209});
    EXPECT_EQ(sut_.acknowledge(0U), Status::kPreconditionNotMet)
        << "two cycles and 99 ns since the clock ran back";
    sut_.report(0U, false, Instant{209});
    EXPECT_EQ(sut_.acknowledge(0U), Status::kPreconditionNotMet) << "three cycles, 99 ns";
    sut_.report(0U, false, Instant{210});
    EXPECT_EQ(sut_.acknowledge(0U), Status::kOk);
}

TEST_F(FaultRegisterTest, HealingOutOfRangeIsRefused) {
    verifies("SWR-FLT-009", Technique::kEquivalenceClasses, Polarity::kViolation);

    EXPECT_EQ(sut_.set_healing(4U, {}), Status::kBadParameter);
    EXPECT_EQ(sut_.set_healing(0U, {0U, Duration{0}}), Status::kBadParameter);
    EXPECT_EQ(sut_.set_healing(0U, {1U, Duration{-1}}), Status::kBadParameter);
    EXPECT_EQ(sut_.set_healing(3U, {1U, Duration{0}}), Status::kOk);
    report(0U, true);
    EXPECT_EQ(sut_.set_healing(0U, {2U, Duration{0}}), Status::kPreconditionNotMet);
    report(0U, false);
    EXPECT_EQ(sut_.set_healing(0U, {2U, Duration{0}}), Status::kPreconditionNotMet) << "latched";
    EXPECT_EQ(sut_.acknowledge(0U), Status::kOk) << "the refused rule is not in force";
}

}  // namespace
}  // namespace mamori::safety
