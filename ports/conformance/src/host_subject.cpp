// SPDX-License-Identifier: Apache-2.0
#include "host_subject.hpp"

#include <algorithm>
#include <utility>

#include "mamori/kernel/base/assert.hpp"

namespace mamori::ports::conformance {
namespace {

/// Maximum wait for the return of released work, in ticks. The contract has no such bound; it only limits the
/// duration of a failing test.
constexpr int kPatience = 120'000;

}  // namespace

Prediction predict(const Order& order) {
    Prediction result;
    const Duration cut_off = order.budget > Duration{0} ? order.budget : Duration{0};
    for (const StepPlan& step : order.steps) {
        if (step.is_hang || result.end + step.time > order.budget) {
            return {result.count, cut_off, step.is_hang};
        }
        result.end = result.end + step.time;
        ++result.count;
    }
    return result;
}

HostSubject::HostSubject(std::unique_ptr<HostRig> rig) : rig_(std::move(rig)), last_(rig_->get_now()) {}

HostSubject::~HostSubject() {
    for (std::size_t window = 0U; window < windows_.size(); ++window) {
        if (!windows_[window].is_at_rest) {
            rig_->release(window);
            static_cast<void>(wait_for_return(window));
        }
    }
}

std::string HostSubject::describe_state() const {
    std::string text;
    for (const Window& window : windows_) {
        const bool is_late = window.counted < window.asked;
        text += window.is_hanging ? "hangs " : window.asked == 0U ? "new " : is_late ? "late " : "in-time ";
    }
    return text;
}

Instant HostSubject::read_now(Judge& judge) {
    const Instant now = rig_->get_host().get_now();
    judge.expect(now >= last_, "the clock ran backwards");
    last_ = now > last_ ? now : last_;
    return now;
}

void HostSubject::run(const Order& order, Judge& judge) {
    check_quiet(judge);
    Window& window = windows_.at(order.window);
    WorkLog& log = logs_.at(order.window);
    MAMORI_REQUIRE(1, window.is_at_rest && order.steps.size() <= HostRig::kStepsMax);
    const WindowHost::Work work{
        &WorkLog::run,      &log,      order.window, order.window * HostRig::kStepsMax, order.first,
        order.steps.size(), order.pass};
    log.prepare(*rig_, order.window, order.first, order.steps);
    rig_->plan(work, order.steps);
    const Prediction prediction = predict(order);
    window.begin = read_now(judge);
    window.deadline = window.begin + order.budget;
    window.latest = prediction.count;
    window.asked = order.steps.size();
    window.is_at_rest = false;

    window.counted = rig_->get_host().run_within(work, window.deadline);

    const Instant after = read_now(judge);
    check_answer(order, prediction, window.counted, after, judge);
    if (window.counted >= order.steps.size()) {
        check_rest(order.window, judge);
    } else if (prediction.has_hang) {
        window.is_hanging = true;
    } else {
        judge.expect(wait_for_return(order.window), "late work never returned");
        check_rest(order.window, judge);
    }
}

/// Checks counts and instants, for which the contract holds before and after the return of the work.
void HostSubject::check_answer(const Order& order, const Prediction& prediction, std::size_t count,
                               Instant after, Judge& judge) {
    const Window& window = windows_.at(order.window);
    judge.expect(count <= prediction.count, "a counted step cannot have returned by the deadline");
    judge.expect(count >= order.steps.size() || after >= window.deadline,
                 "work was aborted before its deadline");
    if (rig_->is_exact()) {
        judge.expect_equal(static_cast<std::int64_t>(count), static_cast<std::int64_t>(prediction.count),
                           "steps counted");
        judge.expect_equal(after, window.begin + prediction.end,
                           "the work did not end at the expected instant");
    }
    check_steps(order.window, std::min(count, order.steps.size()), judge);
    for (std::size_t i = 0U; i < std::min(count, order.steps.size()); ++i) {
        judge.expect(logs_.at(order.window).get_entry(i).end <= window.deadline,
                     "a counted step ended after the deadline");
    }
}

/// Checks the first `count` steps of a window, whose end the host has reported.
void HostSubject::check_steps(std::size_t window, std::size_t count, Judge& judge) const {
    const WorkLog& log = logs_.at(window);
    Instant end = windows_.at(window).begin;
    judge.expect(log.get_begun_count() >= count, "a counted step did not run");
    for (std::size_t i = 0U; i < count; ++i) {
        const WorkLog::Entry& entry = log.get_entry(i);
        judge.expect(entry.number == log.get_first() + i,
                     "a step ran twice, or a step did not run, or the order was wrong");
        judge.expect(entry.has_ended, "the host reported the end of a step that still ran");
        judge.expect(entry.begin >= end, "a step began before the previous step had ended");
        judge.expect(entry.end >= entry.begin, "a step ended before it began");
        end = entry.end;
    }
}

/// Checks the last work of a window, whose end the host has reported.
void HostSubject::check_rest(std::size_t window, Judge& judge) {
    Window& state = windows_.at(window);
    const WorkLog& log = logs_.at(window);
    const std::size_t begun = log.get_begun_count();
    const std::size_t count = log.get_count();
    judge.expect(log.get_ended_count() == begun, "the host reported the end of work while a step ran");
    judge.expect(begun <= count, "more steps ran than the work has");
    judge.expect(begun <= state.latest + 2U, "aborted work began more than one further step");
    check_steps(window, std::min(begun, count), judge);
    if (state.latest < std::min(begun, count)) {
        // A hang is released after the deadline. A coarse clock can show the same instant for both.
        const Duration later = log.get_step(state.latest).is_hang ? 0_ns : 1_ns;
        judge.expect(log.get_entry(state.latest).end >= state.deadline + later,
                     "a step that took longer than the budget did not end after the deadline");
    }
    state.is_hanging = false;
    state.is_at_rest = true;
    state.begun_at_rest = begun;
}

/// Checks that no step begins in a window after the reported end of its work.
void HostSubject::check_quiet(Judge& judge) const {
    for (std::size_t i = 0U; i < windows_.size(); ++i) {
        judge.expect(!windows_[i].is_at_rest || logs_[i].get_begun_count() == windows_[i].begun_at_rest,
                     "a step began after the reported end of its work");
    }
}

void HostSubject::ask(std::size_t window, Judge& judge) {
    const WorkLog& log = logs_.at(window);
    // This order matters: a step that runs now continues to run, since it was not released.
    const bool is_inside = log.get_begun_count() > log.get_ended_count();
    const bool has_returned = rig_->get_host().has_returned(window);
    judge.expect(!(is_inside && has_returned), "the end of hanging work was reported");
    if (has_returned && !is_inside) {
        check_rest(window, judge);  // the work was aborted before the hanging step
    }
    check_quiet(judge);
}

void HostSubject::release(std::size_t window, Judge& judge) {
    rig_->release(window);
    judge.expect(wait_for_return(window), "released work never returned");
    check_rest(window, judge);
    check_quiet(judge);
    static_cast<void>(read_now(judge));
}

void HostSubject::idle(Duration time, Judge& judge) {
    const Instant until = read_now(judge) + time;
    rig_->wait_until(until);
    judge.expect(read_now(judge) >= until, "a wait ended before its instant");
    check_quiet(judge);
}

bool HostSubject::wait_for_return(std::size_t window) {
    for (int i = 0; i < kPatience; ++i) {
        if (rig_->get_host().has_returned(window)) {
            return true;
        }
        rig_->wait_until(rig_->get_now() + rig_->get_tick());
    }
    return false;
}

}  // namespace mamori::ports::conformance
