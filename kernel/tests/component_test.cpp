// SPDX-License-Identifier: Apache-2.0
// Goal: a component comes alive once and ends once, and only when it may.
// Method: a spy component; each status of both operations; calls from within the actions.
#include "mamori/kernel/component/component.hpp"

#include <gtest/gtest.h>

#include <array>

#include "mamori/kernel/component/execution_context.hpp"
#include "mamori/trace/verifies.hpp"
#include "support/spy_component.hpp"

namespace mamori {
namespace {

using testing_support::Calls;
using testing_support::SpyComponent;
using verification::Polarity;
using verification::Technique;
using verification::verifies;

class PlainComponent final : public Component {
  public:
    constexpr PlainComponent() noexcept : Component("plain") {}
};

class ComponentTest : public ::testing::Test {
  protected:
    Calls calls_;
    SpyComponent sut_{"sut", calls_};
};

TEST_F(ComponentTest, InitializeCallsTheActionOnceAndMakesItAlive) {
    verifies("SWR-KRN-011", Technique::kStateTransition);
    ASSERT_FALSE(sut_.is_alive());

    EXPECT_EQ(sut_.initialize(), Status::kOk);

    EXPECT_TRUE(sut_.is_alive());
    EXPECT_EQ(calls_, Calls{"sut.on_initialize"});
    EXPECT_STREQ(sut_.get_name(), "sut");
}

TEST_F(ComponentTest, FinalizeCallsTheActionOnceAndALifeMayBeginAgain) {
    verifies("SWR-KRN-011", Technique::kStateTransition);
    ASSERT_EQ(sut_.initialize(), Status::kOk);

    EXPECT_EQ(sut_.finalize(), Status::kOk);
    EXPECT_FALSE(sut_.is_alive());
    EXPECT_EQ(sut_.initialize(), Status::kOk);

    EXPECT_EQ(calls_, (Calls{"sut.on_initialize", "sut.on_finalize", "sut.on_initialize"}));
}

TEST_F(ComponentTest, InitializeTwiceIsRefusedWithoutACall) {
    verifies("SWR-KRN-011", Technique::kStateTransition, Polarity::kViolation);
    ASSERT_EQ(sut_.initialize(), Status::kOk);

    EXPECT_EQ(sut_.initialize(), Status::kPreconditionNotMet);

    EXPECT_EQ(calls_.size(), 1U);
}

TEST_F(ComponentTest, ARefusedInitializeKeepsItCreatedAndMayBeRepeated) {
    verifies("SWR-KRN-011", Technique::kFaultInjection, Polarity::kViolation);
    sut_.answers["on_initialize"] = Status::kOutOfResources;

    EXPECT_EQ(sut_.initialize(), Status::kOutOfResources);
    EXPECT_FALSE(sut_.is_alive());

    sut_.answers.clear();
    EXPECT_EQ(sut_.initialize(), Status::kOk);
    EXPECT_TRUE(sut_.is_alive());
}

TEST_F(ComponentTest, FinalizeOfACreatedComponentIsRefused) {
    verifies("SWR-KRN-011", Technique::kStateTransition, Polarity::kViolation);

    EXPECT_EQ(sut_.finalize(), Status::kPreconditionNotMet);

    EXPECT_TRUE(calls_.empty());
}

TEST_F(ComponentTest, FinalizeWhileParticipatingIsRefusedUntilTheContextGaveItUp) {
    verifies("SWR-KRN-011", Technique::kStateTransition, Polarity::kViolation);
    const std::array<Component*, 1> participants{&sut_};
    ExecutionContext context;
    ASSERT_EQ(sut_.initialize(), Status::kOk);
    ASSERT_EQ(context.attach(0, participants, ContextPlan{1_ms}), Status::kOk);

    EXPECT_EQ(sut_.finalize(), Status::kPreconditionNotMet);
    EXPECT_TRUE(sut_.is_alive());

    ASSERT_EQ(context.detach(), Status::kOk);
    EXPECT_EQ(sut_.finalize(), Status::kOk);
}

TEST_F(ComponentTest, AFailingFinalizeIsReportedButEndsTheLife) {
    verifies("SWR-KRN-011", Technique::kFaultInjection, Polarity::kViolation);
    sut_.answers["on_finalize"] = Status::kError;
    ASSERT_EQ(sut_.initialize(), Status::kOk);

    EXPECT_EQ(sut_.finalize(), Status::kError);

    EXPECT_FALSE(sut_.is_alive());
}

TEST_F(ComponentTest, OperationsFromWithinTheOwnActionsAreRefused) {
    verifies("SWR-KRN-011", Technique::kErrorGuessing, Polarity::kViolation);
    std::vector<Status> answers;
    sut_.inside = [this, &answers](const std::string&) {
        answers.push_back(sut_.initialize());
        answers.push_back(sut_.finalize());
    };

    EXPECT_EQ(sut_.initialize(), Status::kOk);
    EXPECT_EQ(sut_.finalize(), Status::kOk);

    EXPECT_EQ(answers, std::vector<Status>(4U, Status::kPreconditionNotMet));
    EXPECT_EQ(calls_.size(), 2U);
}

TEST(PlainComponentTest, EveryActionThatIsNotOverriddenSucceeds) {
    verifies("SWR-KRN-011", Technique::kInterface);
    PlainComponent component;
    const ContextHandle handle{0, Instant{}};

    EXPECT_EQ(component.on_initialize(), Status::kOk);
    EXPECT_EQ(component.on_finalize(), Status::kOk);
    EXPECT_EQ(component.on_startup(handle), Status::kOk);
    EXPECT_EQ(component.on_shutdown(handle), Status::kOk);
    EXPECT_EQ(component.on_activated(handle), Status::kOk);
    EXPECT_EQ(component.on_deactivated(handle), Status::kOk);
    EXPECT_EQ(component.on_aborting(handle), Status::kOk);
    EXPECT_EQ(component.on_error(handle), Status::kOk);
    EXPECT_EQ(component.on_reset(handle), Status::kOk);
    EXPECT_EQ(component.on_execute(handle), Status::kOk);
    EXPECT_EQ(component.on_state_update(handle), Status::kOk);
    EXPECT_EQ(component.on_rate_changed(handle), Status::kOk);
    EXPECT_EQ(component.on_action(handle), Status::kOk);
    EXPECT_EQ(component.on_mode_changed(handle), Status::kOk);
}

}  // namespace
}  // namespace mamori
