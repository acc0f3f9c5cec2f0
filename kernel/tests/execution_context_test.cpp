// SPDX-License-Identifier: Apache-2.0
// Goal: each operation of the context does what the standard says and refuses everything else unchanged.
// Method: two spies in one context; each status of each operation; calls from within actions and cycles.
// What a cycle does: execution_cycle_test.cpp.
#include "mamori/kernel/component/execution_context.hpp"

#include <limits>

#include "mamori/trace/verifies.hpp"
#include "mamori/verification/failed_check.hpp"
#include "support/context_fixture.hpp"

namespace mamori {
namespace {

using namespace testing_support;
using namespace verification;

class ExecutionContextTest : public testing_support::ContextFixture {};

TEST_F(ExecutionContextTest, ActionsAreGivenTheIdOfTheirContextAndTheInstantOfTheOperation) {
    verifies("SWR-KRN-012", Technique::kInterface);
    start_and_activate();
    now_ = Instant{2000};

    run_cycle();

    ASSERT_EQ(a_.handles.size(), 4U);
    for (const ContextHandle& handle : a_.handles) {
        EXPECT_EQ(handle.id, kId);
    }
    EXPECT_EQ(a_.handles[1].now, Instant{1000});  // on_activated
    EXPECT_EQ(a_.handles[2].now, Instant{2000});  // on_execute
}

TEST_F(ExecutionContextTest, TheRateIsThatOfTheTable) {
    verifies("SWR-KRN-012", Technique::kInterface);
    const ExecutionContext unattached;

    EXPECT_DOUBLE_EQ(sut_.get_rate(), 1000.0);
    EXPECT_LT(unattached.get_rate(), 0.0);
    EXPECT_EQ(sut_.get_participant_count(), 2U);
    EXPECT_EQ(unattached.get_participant_count(), 0U);
}

TEST_F(ExecutionContextTest, AttachRefusesEachWrongArgumentAndTakesNobody) {
    verifies("SWR-KRN-012", Technique::kBoundaryValues, Polarity::kViolation);
    ExecutionContext other;
    const std::array<Component*, 1> one{&stranger_};
    const std::array<Component*, 2> with_null{&stranger_, nullptr};
    const std::array<Component*, 2> twice{&stranger_, &stranger_};
    const std::array<Component*, 2> taken{&stranger_, &a_};

    EXPECT_EQ(other.attach(-1, one, ContextPlan{1_ms}), Status::kBadParameter);
    EXPECT_EQ(other.attach(0, one, ContextPlan{0_ns}), Status::kBadParameter);
    EXPECT_EQ(other.attach(0, one, ContextPlan{Duration{-1}}), Status::kBadParameter);
    EXPECT_EQ(other.attach(0, {}, ContextPlan{1_ms}), Status::kBadParameter);
    EXPECT_EQ(other.attach(0, with_null, ContextPlan{1_ms}), Status::kBadParameter);
    EXPECT_EQ(other.attach(0, twice, ContextPlan{1_ms}), Status::kBadParameter);
    EXPECT_EQ(other.attach(0, taken, ContextPlan{1_ms}), Status::kBadParameter);
    EXPECT_EQ(sut_.attach(0, one, ContextPlan{1_ms}), Status::kPreconditionNotMet);

    EXPECT_EQ(other.attach(0, one, ContextPlan{1_ns}), Status::kOk) << "nobody was taken by the refused ones";
}

TEST_F(ExecutionContextTest, ARateThatIsNoRateIsABadParameterAndOneThatIsNotDeclaredIsUnsupported) {
    verifies("SWR-KRN-012", Technique::kBoundaryValues, Polarity::kViolation);

    EXPECT_EQ(sut_.set_rate(0.0), Status::kBadParameter);
    EXPECT_EQ(sut_.set_rate(-0.0), Status::kBadParameter);
    EXPECT_EQ(sut_.set_rate(-1.0), Status::kBadParameter);
    EXPECT_EQ(sut_.set_rate(std::numeric_limits<double>::quiet_NaN()), Status::kBadParameter);
    EXPECT_EQ(sut_.set_rate(std::numeric_limits<double>::infinity()), Status::kBadParameter);
    EXPECT_EQ(sut_.set_rate(std::numeric_limits<double>::denorm_min()), Status::kUnsupported);
    EXPECT_EQ(sut_.set_rate(500.0), Status::kUnsupported);

    EXPECT_DOUBLE_EQ(sut_.get_rate(), 1000.0);
    EXPECT_TRUE(calls_.empty());
}

TEST_F(ExecutionContextTest, StepsOutsideACycleOrBeyondTheListEndInTheAssertion) {
    verifies("SWR-KRN-012", Technique::kBoundaryValues, Polarity::kViolation);
    start_and_activate();

    EXPECT_CHECK_FAILS(sut_.execute(0U), "execution_cycle.cpp", 1);
    EXPECT_CHECK_FAILS(sut_.update_state(0U), "execution_cycle.cpp", 1);
    ASSERT_EQ(sut_.begin_cycle(now_), Status::kOk);
    EXPECT_CHECK_FAILS(sut_.execute(2U), "execution_cycle.cpp", 4);
    EXPECT_CHECK_FAILS(sut_.update_state(2U), "execution_cycle.cpp", 4);
    EXPECT_CHECK_FAILS(sut_.execute(3U), "execution_cycle.cpp", 4);
    EXPECT_CHECK_FAILS(sut_.update_state(3U), "execution_cycle.cpp", 4);
}

}  // namespace
}  // namespace mamori
