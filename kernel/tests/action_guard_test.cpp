// SPDX-License-Identifier: Apache-2.0
// Goal: each action outside windows has a budget; one that exceeds it is named, its window is left alone
// until it has returned, and every other window is stopped. Method: an executive with two windows and a host
// that lets the n-th action of one component be late, hang or start late; components that write down their
// actions.
#include "mamori/kernel/run/action_guard.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <vector>

#include "mamori/kernel/run/executives.hpp"
#include "mamori/kernel/system/system.hpp"
#include "mamori/trace/verifies.hpp"
#include "support/fake_host.hpp"

namespace mamori {
namespace {

using namespace verification;
using testing_support::SpyObserver;

constexpr Duration kBudget{500};
using Log = std::vector<std::string>;

Log g_log;

/// Writes down its actions as "name.action". Initialised statically, so the log is a global.
class Noter final : public Component {
  public:
    explicit Noter(const char* name) noexcept : Component(name) {}
    Status initializes{Status::kOk};
    Status starts{Status::kOk};
    Status activates{Status::kOk};
    std::function<void()> during_startup;

    Status on_initialize() noexcept override { return note("initialize", initializes); }
    Status on_finalize() noexcept override { return note("finalize", Status::kOk); }
    Status on_startup(ContextHandle) noexcept override {
        if (during_startup) {
            during_startup();
        }
        return note("startup", starts);
    }
    Status on_shutdown(ContextHandle) noexcept override { return note("shutdown", Status::kOk); }
    Status on_activated(ContextHandle) noexcept override { return note("activated", activates); }
    Status on_deactivated(ContextHandle) noexcept override { return note("deactivated", Status::kOk); }

  private:
    Status note(const char* action, Status status) noexcept {
        g_log.push_back(std::string{get_name()} + "." + action);
        return status;
    }
};

/// How an action exceeds its budget.
enum class Fault {
    kLate,        ///< it has its effect and has not returned
    kNotStarted,  ///< its thread gets the processor after the deadline
};

class ActionHost final : public WindowHost {
  public:
    Instant now{1000};
    Duration duration{0};  ///< of every action
    std::vector<Work> works;
    std::vector<Instant> deadlines;

    void fail_at(std::size_t component, std::size_t nth, Fault fault) {
        component_ = component;
        remaining_ = nth;
        fault_ = fault;
    }
    /// The aborted action returns.
    void finish() {
        if (fault_ == Fault::kNotStarted) {
            out_.run(out_.argument, out_.first, out_.first + 1U);
        }
        is_out_ = false;
    }

    Instant get_now() const noexcept override { return now; }
    Instant get_step_end() const noexcept override { return now; }
    bool has_returned(std::size_t) const noexcept override { return !is_out_; }
    std::size_t run_within(const Work& work, Instant deadline) noexcept override {
        works.push_back(work);
        deadlines.push_back(deadline);
        const bool is_faulty = work.component == component_ && remaining_ > 0U && --remaining_ == 0U;
        if (!is_faulty || fault_ == Fault::kLate) {
            work.run(work.argument, work.first, work.first + 1U);
        }
        if (is_faulty) {
            out_ = work;
            is_out_ = true;
        }
        const bool is_in_time = !is_faulty && duration <= deadline - now;
        now = is_in_time ? now + duration : deadline;
        return is_in_time ? 1U : 0U;
    }

  private:
    std::size_t component_{kNoIndex};
    std::size_t remaining_{0U};
    Fault fault_{Fault::kLate};
    Work out_{};
    bool is_out_{false};
};

class SpyGuard final : public ActionGuard {
  public:
    explicit SpyGuard(WindowHost& host, Duration budget = kBudget) : ActionGuard(host, budget) {}
    Log overruns;

  private:
    void on_action_overrun(std::size_t component, ComponentAction action) noexcept override {
        overruns.push_back(std::to_string(component) + " " + get_name(action));
    }
};

class ActionGuardTest : public ::testing::Test {
  protected:
    ActionGuardTest() { g_log.clear(); }

    static Log take_log() {
        Log log = g_log;
        g_log.clear();
        return log;
    }
    /// Components 0 and 1 are in window 0, component 2 is in window 1.
    Noter a_{"a"};
    Noter b_{"b"};
    Noter c_{"c"};
    decltype(system(frame(1000_ns), window("first", 0_ns, 300_ns, budget(200_ns), run(a_, b_)),
                    window("second", 400_ns, 300_ns, budget(200_ns), run(c_)))) table_ =
        system(frame(1000_ns), window("first", 0_ns, 300_ns, budget(200_ns), run(a_, b_)),
               window("second", 400_ns, 300_ns, budget(200_ns), run(c_)));
    ExecutiveFor<decltype(table_)> sut_{table_};
    ActionHost host_;
    SpyGuard guard_{host_};
};

TEST_F(ActionGuardTest, EachActionIsWorkOfItsWindowWithABudgetOfItsOwn) {
    verifies("SWR-KRN-090");
    host_.duration = kBudget;

    ASSERT_EQ(sut_.initialize(guard_), Status::kOk);
    EXPECT_EQ(take_log(), (Log{"a.initialize", "b.initialize", "c.initialize"}));
    ASSERT_EQ(sut_.start(guard_), Status::kOk);
    EXPECT_EQ(take_log(),
              (Log{"a.startup", "b.startup", "c.startup", "a.activated", "b.activated", "c.activated"}));
    EXPECT_TRUE(sut_.get_context(0U).is_running());
    EXPECT_EQ(sut_.get_context(0U).get_state_at(1U), LifecycleState::kActive);
    ASSERT_EQ(sut_.stop(guard_), Status::kOk);
    EXPECT_EQ(take_log(), (Log{"c.deactivated", "c.shutdown", "b.deactivated", "a.deactivated", "a.shutdown",
                               "b.shutdown"}));
    ASSERT_EQ(sut_.finalize(guard_), Status::kOk);
    EXPECT_EQ(take_log(), (Log{"c.finalize", "b.finalize", "a.finalize"}));

    EXPECT_TRUE(guard_.overruns.empty());
    ASSERT_EQ(host_.works.size(), 18U);
    Instant start{1000};
    for (std::size_t i = 0U; i < host_.works.size(); ++i) {
        const WindowHost::Work& work = host_.works[i];
        EXPECT_EQ(work.pass, WindowHost::Pass::kAction);
        EXPECT_EQ(work.count, 1U);
        EXPECT_EQ(work.window, work.component == 2U ? 1U : 0U);
        EXPECT_EQ(work.first, work.component % 2U);
        EXPECT_EQ(host_.deadlines[i], start + kBudget);
        start = start + host_.duration;
    }
}

TEST_F(ActionGuardTest, OperationsFromWithinAnActionAreRejected) {
    verifies("SWR-KRN-090", Technique::kErrorGuessing, Polarity::kViolation);
    std::vector<Status> results;
    a_.during_startup = [&] {
        results = {sut_.initialize(guard_), sut_.start(guard_), sut_.stop(guard_), sut_.finalize(guard_)};
    };
    ASSERT_EQ(sut_.initialize(guard_), Status::kOk);
    ASSERT_EQ(sut_.start(guard_), Status::kOk);

    EXPECT_EQ(results, std::vector<Status>(4U, Status::kPreconditionNotMet));
    EXPECT_EQ(sut_.stop(guard_), Status::kOk);
}

TEST_F(ActionGuardTest, BudgetIsExceededByTheFirstNanosecondAfterIt) {
    verifies("SWR-KRN-090", Technique::kBoundaryValues, Polarity::kViolation);
    host_.duration = kBudget + 1_ns;

    EXPECT_EQ(sut_.initialize(guard_), Status::kError);
    EXPECT_EQ(guard_.overruns, (Log{"0 on_initialize"}));
    EXPECT_EQ(host_.now, Instant{1000} + kBudget);
    EXPECT_EQ(sut_.get_failed_component(), 0U);
}

TEST_F(ActionGuardTest, ActionsThatFailHaveTheConsequencesOfDirectCalls) {
    verifies("SWR-KRN-090", Technique::kBackToBack, Polarity::kViolation);
    for (Status Noter::* const failing : {&Noter::initializes, &Noter::starts, &Noter::activates}) {
        std::vector<Log> logs;
        for (const bool is_guarded : {false, true}) {
            ActionHost host;
            SpyGuard guard{host};
            Noter first{"a"};
            Noter second{"b"};
            const auto table =
                system(frame(1000_ns), window("only", 0_ns, 300_ns, budget(200_ns), run(first, second)));
            ExecutiveFor sut{table};
            second.*failing = Status::kUnsupported;
            Status status = is_guarded ? sut.initialize(guard) : sut.initialize();
            if (status == Status::kOk) {
                status = is_guarded ? sut.start(guard) : sut.start();
            }
            EXPECT_EQ(status, Status::kUnsupported);
            EXPECT_EQ(sut.get_failed_component(), 1U);
            EXPECT_FALSE(sut.get_context(0U).is_running());
            EXPECT_TRUE(guard.overruns.empty());
            const Status again = is_guarded ? sut.stop(guard) : sut.stop();
            EXPECT_EQ(again, failing == &Noter::initializes ? Status::kPreconditionNotMet : Status::kOk);
            logs.push_back(take_log());
            logs.back().emplace_back(get_name(second.get_last_failure().action));
        }
        EXPECT_EQ(logs[0], logs[1]);
    }
}

TEST_F(ActionGuardTest, OperationsThatAreNotAdmittedCallNoAction) {
    verifies("SWR-KRN-090", Technique::kEquivalenceClasses, Polarity::kViolation);
    EXPECT_EQ(sut_.start(guard_), Status::kPreconditionNotMet);
    EXPECT_EQ(sut_.stop(guard_), Status::kPreconditionNotMet);
    EXPECT_EQ(sut_.finalize(guard_), Status::kPreconditionNotMet);
    ASSERT_EQ(sut_.initialize(guard_), Status::kOk);
    EXPECT_EQ(sut_.initialize(guard_), Status::kPreconditionNotMet);
    ASSERT_EQ(sut_.start(guard_), Status::kOk);
    take_log();

    EXPECT_EQ(sut_.start(guard_), Status::kPreconditionNotMet);
    EXPECT_EQ(sut_.finalize(guard_), Status::kPreconditionNotMet);
    ExecutionContext& context = sut_.get_context(0U);
    EXPECT_EQ(context.start(Instant{0}, guard_), Status::kPreconditionNotMet);
    EXPECT_EQ(context.activate_component(a_, Instant{0}, guard_), Status::kPreconditionNotMet);
    EXPECT_EQ(context.deactivate_component(c_, Instant{0}, guard_), Status::kBadParameter);
    EXPECT_EQ(take_log(), Log{});
}

/// Action of component b that exceeds its budget, and the actions that are called nevertheless.
struct LateAction {
    std::size_t nth;  ///< of the actions of b
    const char* name;
    Log log;                     ///< of the operation, without the late action if it does not start
    bool is_start;               ///< the operation that fails sets the failed component
    bool is_running;             ///< the first context afterwards
    Log stop_after_late;         ///< of a stop() after the action has returned
    Log stop_after_not_started;  ///< likewise
};

class LateActionTest : public ActionGuardTest, public ::testing::WithParamInterface<LateAction> {};

Status run_until_failure(Executive& sut, ActionGuard& guard) {
    Status status = sut.initialize(guard);
    for (int step = 0; step < 3 && status == Status::kOk; ++step) {
        g_log.clear();
        status = step == 0 ? sut.start(guard) : step == 1 ? sut.stop(guard) : sut.finalize(guard);
    }
    return status;
}

TEST_P(LateActionTest, IsNamedAndStopsEveryOtherWindow) {
    verifies("SWR-KRN-091", Technique::kFaultInjection, Polarity::kViolation);
    SpyObserver observer;
    sut_.set_observer(&observer);
    host_.fail_at(1U, GetParam().nth, Fault::kNotStarted);

    EXPECT_EQ(run_until_failure(sut_, guard_), Status::kError);

    EXPECT_EQ(take_log(), GetParam().log);
    EXPECT_EQ(guard_.overruns, (Log{"1 " + std::string{GetParam().name}}));
    EXPECT_EQ(observer.heard,
              (Log{"overrun window 0 component 1 @" + std::to_string((Instant{1000} + kBudget).ns)}));
    EXPECT_TRUE(!GetParam().is_start || sut_.get_failed_component() == 1U);
    EXPECT_FALSE(sut_.get_context(1U).is_running());
    EXPECT_EQ(sut_.get_context(0U).is_running(), GetParam().is_running);
    EXPECT_TRUE(sut_.get_context(0U).is_busy());
    EXPECT_EQ(sut_.get_context(0U).get_acting_position().get_value(), 1U);
}

TEST_P(LateActionTest, WindowIsLeftAloneUntilTheActionHasReturnedAndUsableThen) {
    verifies("SWR-KRN-093", Technique::kFaultInjection, Polarity::kViolation);
    for (const Fault fault : {Fault::kNotStarted, Fault::kLate}) {
        ActionHost host;
        SpyGuard guard{host};
        Noter first{"a"};
        Noter second{"b"};
        Noter third{"c"};
        const auto table =
            system(frame(1000_ns), window("first", 0_ns, 300_ns, budget(200_ns), run(first, second)),
                   window("second", 400_ns, 300_ns, budget(200_ns), run(third)));
        ExecutiveFor sut{table};
        host.fail_at(1U, GetParam().nth, fault);
        ASSERT_EQ(run_until_failure(sut, guard), Status::kError);
        take_log();

        EXPECT_NE(sut.initialize(guard), Status::kOk);
        EXPECT_NE(sut.initialize(), Status::kOk);
        EXPECT_NE(sut.start(guard), Status::kOk);
        EXPECT_NE(sut.start(), Status::kOk);
        static_cast<void>(sut.stop(guard));
        EXPECT_NE(sut.finalize(guard), Status::kOk);
        EXPECT_NE(sut.finalize(), Status::kOk);
        EXPECT_EQ(take_log(), Log{});
        EXPECT_EQ(guard.overruns.size(), 1U);

        host.finish();
        EXPECT_EQ(take_log(), Log{}) << "an action that starts after its deadline is not called";
        static_cast<void>(sut.stop(guard));
        EXPECT_EQ(take_log(),
                  fault == Fault::kLate ? GetParam().stop_after_late : GetParam().stop_after_not_started);
        static_cast<void>(sut.initialize(guard));
        EXPECT_EQ(sut.start(guard), Status::kOk);
        EXPECT_EQ(sut.stop(guard), Status::kOk);
        EXPECT_EQ(sut.finalize(guard), Status::kOk);
        EXPECT_FALSE(first.is_alive() || second.is_alive() || third.is_alive());
    }
}

INSTANTIATE_TEST_SUITE_P(
    Actions, LateActionTest,
    ::testing::Values(LateAction{1U, "on_initialize", {"a.initialize"}, true, false, {}, {}},
                      LateAction{2U, "on_startup", {"a.startup"}, true, false, {}, {}},
                      LateAction{3U,
                                 "on_activated",
                                 {"a.startup", "b.startup", "c.startup", "a.activated", "c.shutdown"},
                                 true,
                                 true,
                                 {"b.deactivated", "a.deactivated", "a.shutdown", "b.shutdown"},
                                 {"a.deactivated", "a.shutdown", "b.shutdown"}},
                      LateAction{4U,
                                 "on_deactivated",
                                 {"c.deactivated", "c.shutdown"},
                                 false,
                                 true,
                                 {"a.deactivated", "a.shutdown", "b.shutdown"},
                                 {"b.deactivated", "a.deactivated", "a.shutdown", "b.shutdown"}},
                      LateAction{
                          5U,
                          "on_shutdown",
                          {"c.deactivated", "c.shutdown", "b.deactivated", "a.deactivated", "a.shutdown"},
                          false,
                          false,
                          {},
                          {}},
                      LateAction{6U, "on_finalize", {"c.finalize"}, false, false, {}, {}}),
    [](const auto& row) { return row.param.name; });

}  // namespace
}  // namespace mamori
