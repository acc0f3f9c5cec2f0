// SPDX-License-Identifier: Apache-2.0
#include "mamori/safety/self_test/schedule.hpp"

#include "mamori/safety/base/elapsed.hpp"

namespace mamori::safety {

std::size_t SelfTestSchedule::calc_step_count() const noexcept {
    std::size_t count = 0U;
    for (const SelfTest* const test : tests_) {
        count += test->get_step_count();
    }
    return count;
}

void SelfTestSchedule::begin(std::size_t test) noexcept {
    test_ = test;
    steps_ = 0U;
    tests_[test]->begin();
}

SelfTestStatus SelfTestSchedule::fail(SelfTestFailure failure) noexcept {
    status_ = SelfTestStatus::kFailed;
    failure_ = failure;
    return status_;
}

Status SelfTestSchedule::start(Instant now, Duration period) noexcept {
    if (failure_ != SelfTestFailure::kNone) {
        return Status::kPreconditionNotMet;
    }
    if (period <= Duration{0}) {
        return Status::kBadParameter;
    }
    const auto steps_that_fit = static_cast<std::uint64_t>(interval_.ns / period.ns);
    if (calc_step_count() > steps_that_fit) {
        return Status::kBadParameter;
    }
    is_started_ = true;
    status_ = SelfTestStatus::kRunning;
    pass_began_ = now;
    begin(0U);
    return Status::kOk;
}

void SelfTestSchedule::end_test(Instant now) noexcept {
    const std::size_t next = test_ + 1U;
    if (next < tests_.size()) {
        begin(next);
        return;
    }
    ++passes_;
    status_ = SelfTestStatus::kPassed;
    pass_began_ = now;
    begin(0U);
}

SelfTestStatus SelfTestSchedule::step(Instant now) noexcept {
    if (failure_ != SelfTestFailure::kNone || !is_started_) {
        return status_;
    }
    if (is_over(pass_began_, now, interval_)) {
        return fail(SelfTestFailure::kOverdue);
    }
    const SelfTestStatus result = tests_[test_]->step();
    ++steps_;
    if (result >= SelfTestStatus::kFailed) {  // so is a corrupted status
        return fail(SelfTestFailure::kFault);
    }
    const bool has_ended = result == SelfTestStatus::kPassed;
    if (has_ended != (steps_ == tests_[test_]->get_step_count())) {
        return fail(SelfTestFailure::kStepCount);
    }
    if (has_ended) {
        end_test(now);
    }
    return status_;
}

}  // namespace mamori::safety
