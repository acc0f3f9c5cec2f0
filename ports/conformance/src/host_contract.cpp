// SPDX-License-Identifier: Apache-2.0
#include "mamori/ports/conformance/host_contract.hpp"

#include <utility>

#include "host_subject.hpp"
#include "mamori/ports/conformance/rule_trial.hpp"

namespace mamori::ports::conformance {
namespace {

using Pass = WindowHost::Pass;

constexpr const char* kOrder = "SWR-CNF-002";
constexpr const char* kCount = "SWR-CNF-003";
constexpr const char* kCutOff = "SWR-CNF-004";
constexpr const char* kReturn = "SWR-CNF-005";

/// Budget in ticks, sufficient on every host.
constexpr std::int64_t kPlenty = 60'000;
constexpr std::int64_t kHang = -1;

/// An order with times in ticks.
struct OrderPlan {
    std::vector<std::int64_t> steps;
    std::int64_t budget;
    Duration more{0};  ///< added to the budget
    Pass pass{Pass::kExecute};
    std::size_t first{0U};
};

Order make_order(const OrderPlan& plan, std::size_t window, Duration tick) {
    Order order{window, plan.first, plan.pass, {}, tick * plan.budget + plan.more};
    for (const std::int64_t ticks : plan.steps) {
        order.steps.push_back(ticks == kHang ? StepPlan{Duration{0}, true} : StepPlan{tick * ticks, false});
    }
    return order;
}

Rule<HostSubject> make_run(const std::string& name, const char* requirement, std::size_t window,
                           const OrderPlan& plan) {
    return {name + ", window " + std::to_string(window), requirement,
            [window](const HostSubject& subject) { return !subject.is_hanging(window); },
            [window, plan](HostSubject& subject, Judge& judge) {
                subject.run(make_order(plan, window, subject.get_tick()), judge);
            }};
}

/// Work that a hanging window must not disturb.
Rule<HostSubject> make_beside(std::size_t window, std::size_t hanging) {
    Rule<HostSubject> rule = make_run("work during a hang of window " + std::to_string(hanging), kCutOff,
                                      window, {{0, 0, 0}, kPlenty});
    rule.precondition = [window, hanging](const HostSubject& subject) {
        return !subject.is_hanging(window) && subject.is_hanging(hanging);
    };
    return rule;
}

/// Work that returns, in time or late.
void add_work_rules(std::size_t window, Rules<HostSubject>& rules) {
    rules.push_back(make_run("work that fits", kCount, window, {{0, 1, 0, 1}, kPlenty}));
    rules.push_back(make_run("one step", kOrder, window, {{1}, kPlenty}));
    rules.push_back(make_run("numbers that do not start at 0", kOrder, window,
                             {{0, 0}, kPlenty, 0_ns, Pass::kExecute, 7U}));
    rules.push_back(make_run("second pass", kOrder, window, {{0, 0, 0}, kPlenty, 0_ns, Pass::kStateUpdate}));
    rules.push_back(make_run("mode step", kOrder, window, {{1, 0}, kPlenty, 0_ns, Pass::kModeStep}));
    rules.push_back(make_run("a late mode step", kCount, window, {{3, 0}, 2, 0_ns, Pass::kModeStep}));
    rules.push_back(make_run("a late step", kCount, window, {{0, 5, 0, 0}, 3}));
    rules.push_back(make_run("work that ends at its deadline", kCount, window, {{1, 2}, 3}));
    rules.push_back(make_run("work that ends a nanosecond late", kCount, window, {{1, 2}, 3, Duration{-1}}));
    rules.push_back(make_run("no budget", kCount, window, {{0, 1}, 0}));
    rules.push_back(make_run("a deadline that has passed", kCount, window, {{0, 0}, 0, Duration{-1}}));
}

/// Work that returns only after its release.
void add_hang_rules(std::size_t window, Rules<HostSubject>& rules) {
    const auto is_hanging = [window](const HostSubject& subject) { return subject.is_hanging(window); };
    const std::string suffix = ", window " + std::to_string(window);
    rules.push_back(make_run("a hang of the second step", kCutOff, window, {{0, kHang, 0}, 2}));
    rules.push_back({"query during the hang" + suffix, kReturn, is_hanging,
                     [window](HostSubject& subject, Judge& judge) { subject.ask(window, judge); }});
    rules.push_back({"release" + suffix, kReturn, is_hanging,
                     [window](HostSubject& subject, Judge& judge) { subject.release(window, judge); }});
    rules.push_back(make_run("a hang of the first step", kCutOff, window, {{kHang, 0, 0, 0}, 2}));
    rules.push_back(
        make_run("a hang in a mode step", kCutOff, window, {{0, kHang}, 2, 0_ns, Pass::kModeStep}));
    rules.push_back(make_run("a hang after the deadline", kCutOff, window, {{kHang}, -1}));
}

Rules<HostSubject> make_rules() {
    Rules<HostSubject> rules;
    add_work_rules(0U, rules);
    add_hang_rules(1U, rules);
    add_hang_rules(2U, rules);
    rules.push_back(make_beside(0U, 1U));
    rules.push_back(make_beside(1U, 2U));
    rules.push_back(make_run("work that fits", kCount, 1U, {{0, 1, 0, 1}, kPlenty}));
    rules.push_back(make_run("a late step", kCount, 1U, {{0, 5, 0, 0}, 3}));
    rules.push_back({"time passes", kReturn, [](const HostSubject&) { return true; },
                     [](HostSubject& subject, Judge& judge) { subject.idle(subject.get_tick(), judge); }});
    return rules;
}

}  // namespace

TrialFactory make_host_trials(RigFactory<HostRig> make_rig) {
    return make_trials<HostSubject>(
        make_rules(), [make_rig = std::move(make_rig)] { return std::make_unique<HostSubject>(make_rig()); });
}

}  // namespace mamori::ports::conformance
