// SPDX-License-Identifier: Apache-2.0
// Goal: a mode changes at the component's next turn, or at once, and the component is told before it
// executes. Method: a spy with three modes beside a plain one; pending and immediate changes in each state,
// from inside and outside; each answer of on_mode_changed.
#include "mamori/kernel/component/multi_mode.hpp"

#include <gtest/gtest.h>

#include <array>

#include "mamori/kernel/component/execution_context.hpp"
#include "mamori/trace/verifies.hpp"
#include "support/spy_component.hpp"

namespace mamori {
namespace {

using namespace testing_support;
using namespace verification;

constexpr Mode kNormal{"normal"};
constexpr Mode kSlow{"slow"};
constexpr Mode kFailSafe{"fail safe"};
constexpr Mode kForeign{"foreign"};
constexpr std::array<const Mode*, 3> kModes{&kNormal, &kSlow, &kFailSafe};

class SpyModes final : public SpyActions<MultiModeComponent> {
  public:
    explicit SpyModes(Calls& calls) : SpyActions(calls, "m", kModes) {}
};

class MultiModeTest : public ::testing::Test {
  protected:
    void SetUp() override {
        ASSERT_EQ(sut_.initialize(), Status::kOk);
        ASSERT_EQ(context_.attach(5, participants_, ContextPlan{1_ms}), Status::kOk);
        ASSERT_EQ(context_.start(now_), Status::kOk);
        ASSERT_EQ(context_.activate_component(sut_, now_), Status::kOk);
        calls_.clear();
    }
    Calls run_cycle() {
        EXPECT_EQ(context_.begin_cycle(now_), Status::kOk);
        context_.execute(0U);
        context_.update_state(0U);
        context_.end_cycle();
        return take(calls_);
    }
    LifecycleState get_state() const { return context_.get_state_at(0U); }

    Calls calls_;
    SpyModes sut_{calls_};
    std::array<Component*, 1> participants_{&sut_};
    Instant now_{1000};
    ExecutionContext context_;
    ExecutionContext other_;
};

TEST_F(MultiModeTest, ItBeginsInItsDefaultMode) {
    verifies("SWR-RTC-007");

    EXPECT_EQ(&sut_.get_default_mode(), &kNormal);
    EXPECT_EQ(&sut_.get_current_mode(), &kNormal);
    EXPECT_EQ(sut_.get_pending_mode(), nullptr);
    EXPECT_EQ(sut_.get_current_mode_in_context(context_), &kNormal);
    EXPECT_EQ(sut_.get_pending_mode_in_context(context_), nullptr);
    EXPECT_EQ(run_cycle(), (Calls{"m.on_execute", "m.on_state_update"})) << "nothing has changed";
}

TEST_F(MultiModeTest, APendingModeBecomesCurrentInTheNextCycleBeforeOnExecute) {
    verifies("SWR-RTC-007", Technique::kStateTransition);

    EXPECT_EQ(sut_.set_mode(kSlow, false, now_), Status::kOk);
    EXPECT_EQ(&sut_.get_current_mode(), &kNormal);
    EXPECT_EQ(sut_.get_pending_mode(), &kSlow);
    EXPECT_EQ(sut_.get_pending_mode_in_context(context_), &kSlow);
    EXPECT_TRUE(calls_.empty());
    sut_.inside = [this](const std::string&) { EXPECT_EQ(&sut_.get_current_mode(), &kSlow); };

    EXPECT_EQ(run_cycle(), (Calls{"m.on_mode_changed", "m.on_execute", "m.on_state_update"}));
    EXPECT_EQ(sut_.get_pending_mode(), nullptr);
    EXPECT_EQ(run_cycle(), (Calls{"m.on_execute", "m.on_state_update"})) << "told once";
}

TEST_F(MultiModeTest, AnImmediateModeIsCurrentAndToldAtOnce) {
    verifies("SWR-RTC-007", Technique::kStateTransition);
    ASSERT_EQ(sut_.set_mode(kSlow, false, now_), Status::kOk);
    sut_.inside = [this](const std::string&) { EXPECT_EQ(context_.get_acting_position().get_value(), 0U); };

    EXPECT_EQ(sut_.set_mode(kFailSafe, true, Instant{2000}), Status::kOk);

    EXPECT_EQ(&sut_.get_current_mode(), &kFailSafe);
    EXPECT_EQ(sut_.get_pending_mode(), nullptr) << "the earlier wish is gone";
    EXPECT_EQ(take(calls_), Calls{"m.on_mode_changed"});
    EXPECT_EQ(sut_.handles.back().now, Instant{2000});
    EXPECT_EQ(sut_.handles.back().id, 5);
    EXPECT_EQ(run_cycle(), (Calls{"m.on_execute", "m.on_state_update"}));
}

TEST_F(MultiModeTest, AnImmediateModeFromWithinAnActionIsCurrentAtOnceAndToldInTheNextTurn) {
    verifies("SWR-RTC-007", Technique::kErrorGuessing);
    sut_.inside = [this](const std::string& action) {
        if (action == "on_execute") {
            EXPECT_EQ(sut_.set_mode(kFailSafe, true, now_), Status::kOk);
            EXPECT_EQ(&sut_.get_current_mode(), &kFailSafe);
        }
    };

    EXPECT_EQ(run_cycle(), (Calls{"m.on_execute", "m.on_state_update"})) << "never reentrant";
    sut_.inside = nullptr;

    EXPECT_EQ(run_cycle(), (Calls{"m.on_mode_changed", "m.on_execute", "m.on_state_update"}));
}

TEST_F(MultiModeTest, AChangeThatIsTakenBackIsNotTold) {
    verifies("SWR-RTC-007", Technique::kStateTransition);
    ASSERT_EQ(sut_.set_mode(kSlow, false, now_), Status::kOk);

    EXPECT_EQ(sut_.set_mode(kNormal, false, now_), Status::kOk);
    EXPECT_EQ(sut_.get_pending_mode(), nullptr);
    EXPECT_EQ(run_cycle(), (Calls{"m.on_execute", "m.on_state_update"}));

    EXPECT_EQ(sut_.set_mode(kNormal, true, now_), Status::kOk);
    EXPECT_TRUE(calls_.empty());
}

TEST_F(MultiModeTest, AModeChangesAlsoWhileItIsInactiveOrInError) {
    verifies("SWR-RTC-007", Technique::kStateTransition);
    ASSERT_EQ(context_.deactivate_component(sut_, now_), Status::kOk);
    ASSERT_EQ(sut_.set_mode(kSlow, false, now_), Status::kOk);
    calls_.clear();
    EXPECT_EQ(run_cycle(), Calls{"m.on_mode_changed"});
    ASSERT_EQ(context_.activate_component(sut_, now_), Status::kOk);
    sut_.answers["on_execute"] = Status::kError;
    run_cycle();
    ASSERT_EQ(get_state(), LifecycleState::kError);

    ASSERT_EQ(sut_.set_mode(kNormal, false, now_), Status::kOk);

    EXPECT_EQ(run_cycle(), (Calls{"m.on_mode_changed", "m.on_error"}));
    EXPECT_EQ(&sut_.get_current_mode(), &kNormal);
}

TEST_F(MultiModeTest, APendingModeWaitsWhileTheContextIsStopped) {
    verifies("SWR-RTC-007", Technique::kStateTransition);
    ASSERT_EQ(context_.stop(now_), Status::kOk);
    ASSERT_EQ(sut_.set_mode(kSlow, false, now_), Status::kOk);
    ASSERT_EQ(context_.start(now_), Status::kOk);
    EXPECT_EQ(sut_.get_pending_mode(), &kSlow);
    calls_.clear();

    EXPECT_EQ(run_cycle(), (Calls{"m.on_mode_changed", "m.on_execute", "m.on_state_update"}));
}

TEST_F(MultiModeTest, APendingModeWaitsForTheNextLifeInItsPlace) {
    verifies("SWR-RTC-007", Technique::kErrorGuessing);
    ASSERT_EQ(sut_.set_mode(kSlow, false, now_), Status::kOk);
    ASSERT_EQ(sut_.exit(now_), Status::kOk);
    calls_.clear();
    EXPECT_EQ(run_cycle(), Calls{}) << "its place is empty";
    EXPECT_EQ(sut_.get_pending_mode(), &kSlow);

    ASSERT_EQ(sut_.initialize(), Status::kOk);
    calls_.clear();

    EXPECT_EQ(run_cycle(), Calls{"m.on_mode_changed"});
    EXPECT_EQ(&sut_.get_current_mode(), &kSlow);
    EXPECT_EQ(sut_.get_pending_mode(), nullptr);
}

TEST_F(MultiModeTest, WithoutAContextAModeIsCommittedAtOnceAndNotTold) {
    verifies("SWR-RTC-007", Technique::kStateTransition);
    ASSERT_EQ(context_.deactivate_component(sut_, now_), Status::kOk);
    ASSERT_EQ(context_.stop(now_), Status::kOk);
    ASSERT_EQ(sut_.set_mode(kSlow, false, now_), Status::kOk);
    ASSERT_EQ(context_.detach(), Status::kOk);
    EXPECT_EQ(&sut_.get_current_mode(), &kSlow) << "nobody is left who could wait";
    EXPECT_EQ(sut_.get_current_mode_in_context(context_), nullptr);
    EXPECT_EQ(sut_.get_pending_mode_in_context(context_), nullptr);
    calls_.clear();

    EXPECT_EQ(sut_.set_mode(kFailSafe, false, now_), Status::kOk);
    EXPECT_EQ(&sut_.get_current_mode(), &kFailSafe);
    EXPECT_EQ(sut_.get_pending_mode(), nullptr);
    ASSERT_EQ(context_.attach(5, participants_, ContextPlan{1_ms}), Status::kOk);
    ASSERT_EQ(context_.start(now_), Status::kOk);
    calls_.clear();

    EXPECT_EQ(run_cycle(), Calls{});
}

TEST_F(MultiModeTest, AForeignModeIsRefused) {
    verifies("SWR-RTC-007", Technique::kEquivalenceClasses, Polarity::kViolation);
    const Mode same_name{"slow"};
    ASSERT_EQ(sut_.set_mode(kSlow, false, now_), Status::kOk);

    EXPECT_EQ(sut_.set_mode(kForeign, false, now_), Status::kBadParameter);
    EXPECT_EQ(sut_.set_mode(kForeign, true, now_), Status::kBadParameter);
    EXPECT_EQ(sut_.set_mode(same_name, true, now_), Status::kBadParameter) << "its identity is its address";

    EXPECT_EQ(sut_.get_pending_mode(), &kSlow) << "unchanged";
    EXPECT_EQ(&sut_.get_current_mode(), &kNormal);
    EXPECT_EQ(sut_.get_current_mode_in_context(other_), nullptr);
    EXPECT_EQ(sut_.get_pending_mode_in_context(other_), nullptr);
}

class ModeFailureTest : public MultiModeTest, public ::testing::WithParamInterface<Status> {};

TEST_P(ModeFailureTest, ARefusedPendingModeLeadsAnActiveComponentToErrorAndStaysSet) {
    verifies("SWR-RTC-004", Technique::kFaultInjection, Polarity::kViolation);
    ASSERT_EQ(sut_.set_mode(kSlow, false, now_), Status::kOk);
    sut_.answers["on_mode_changed"] = GetParam();

    EXPECT_EQ(run_cycle(), (Calls{"m.on_mode_changed", "m.on_aborting"}));

    EXPECT_EQ(get_state(), LifecycleState::kError);
    EXPECT_EQ(&sut_.get_current_mode(), &kSlow);
    EXPECT_EQ(sut_.get_last_failure().action, ComponentAction::kModeChanged);
    EXPECT_EQ(run_cycle(), Calls{"m.on_error"});
}

TEST_P(ModeFailureTest, ARefusedImmediateModeIsTheCallersAnswerToo) {
    verifies("SWR-RTC-004", Technique::kFaultInjection, Polarity::kViolation);
    sut_.answers["on_mode_changed"] = GetParam();

    EXPECT_EQ(sut_.set_mode(kFailSafe, true, now_), GetParam());

    EXPECT_EQ(get_state(), LifecycleState::kError);
    EXPECT_EQ(&sut_.get_current_mode(), &kFailSafe);
    EXPECT_EQ(take(calls_), (Calls{"m.on_mode_changed", "m.on_aborting"}));
}

INSTANTIATE_TEST_SUITE_P(AllCodes, ModeFailureTest,
                         ::testing::Values(Status::kError, Status::kBadParameter, Status::kUnsupported,
                                           Status::kOutOfResources, Status::kPreconditionNotMet),
                         [](const auto& parameter) { return std::string(get_name(parameter.param)); });

}  // namespace
}  // namespace mamori
