// SPDX-License-Identifier: Apache-2.0
// A host in simulated time that complies with the contract or has one selected defect.
#ifndef MAMORI_PORTS_CONFORMANCE_TESTS_SUPPORT_EXACT_HOST_HPP
#define MAMORI_PORTS_CONFORMANCE_TESTS_SUPPORT_EXACT_HOST_HPP

#include <vector>

#include "mamori/ports/conformance/host_contract.hpp"

namespace mamori::ports::conformance {

enum class HostFlaw {
    kNone,
    kClockGoesBack,
    kRunsStepTwice,
    kSkipsStep,
    kRunsBackwards,
    kIgnoresFirstNumber,
    kForgetsSecondPass,
    kCountsCutOffStep,
    kCountsTooFew,
    kCountsTooMany,
    kIsGenerous,
    kIgnoresPassedDeadline,
    kCutsTooEarly,
    kDoesNotCut,
    kNeedsOthersToReturn,
    kStepEndsBeforeItBegins,
    kLateStepEndsInTime,
    kRunsAbandonedStepLater,
    kEntersOneAbandonedStep,  ///< permitted
    kEntersAllAbandonedSteps,
    kNeverSaysReturned,
    kForgetsReturnOfAHang,
    kStepsOverlap,
    kCountedStepEndsLate,
    kRunsOneStepMore,
    kWakesEarly,
};

class ExactHost final : public WindowHost {
  public:
    explicit ExactHost(HostFlaw flaw) : flaw_(flaw) {}

    Instant get_now() const noexcept override { return now_; }
    Instant get_step_end() const noexcept override { return step_end_; }
    bool has_returned(std::size_t) const noexcept override {
        return flaw_ != HostFlaw::kNeverSaysReturned && !is_return_forgotten_;
    }

    std::size_t run_within(const Work& work, Instant deadline) noexcept override {
        run_left_over(work.window);
        if (has(HostFlaw::kClockGoesBack) && now_ > Instant{}) {
            now_ = now_ - 2_us;
        }
        const bool is_disturbed = has(HostFlaw::kNeedsOthersToReturn) && is_hang_out_;
        for (std::size_t i = 0U; i < work.count; ++i) {
            const StepPlan& plan = plans_[i];
            const bool is_in_time = !is_disturbed && !plan.is_hang && may_end(plan.time, deadline);
            const Instant cut_off = deadline > now_ ? deadline : now_;
            step_end_ = is_in_time ? now_ + plan.time : cut_off + 1_ns;
            if (has(HostFlaw::kStepEndsBeforeItBegins)) {
                step_end_ = now_ - 1_ns;
            } else if (has(HostFlaw::kLateStepEndsInTime) && !is_in_time) {
                step_end_ = cut_off;
            } else if (has(HostFlaw::kStepsOverlap) && is_in_time && i + 1U < work.count) {
                step_end_ = step_end_ + 1_ns;
            } else if (has(HostFlaw::kCountedStepEndsLate) && is_in_time && i + 1U == work.count) {
                step_end_ = deadline + 1_ns;
            }
            if (!plan.is_hang) {
                run(work, i);
            }
            if (!is_in_time) {
                return cut(work, i, cut_off, plan);
            }
            now_ = now_ + plan.time;
        }
        if (has(HostFlaw::kRunsOneStepMore)) {
            run(work, work.count);
        }
        const bool is_one_less = has(HostFlaw::kCountsTooFew) && work.count > 1U;
        return is_one_less ? work.count - 1U : has(HostFlaw::kCountsTooMany) ? work.count + 1U : work.count;
    }

    void set_plans(const std::vector<StepPlan>& plans) { plans_ = plans; }
    void advance_to(Instant instant) {
        const Instant until = has(HostFlaw::kWakesEarly) ? instant - 1_ns : instant;
        now_ = until > now_ ? until : now_;
    }
    void release() { is_hang_out_ = false; }

  private:
    bool has(HostFlaw flaw) const noexcept { return flaw_ == flaw; }

    bool may_end(Duration time, Instant deadline) const noexcept {
        if (has(HostFlaw::kIgnoresPassedDeadline) && deadline < now_) {
            return true;
        }
        return now_ + time <= (has(HostFlaw::kIsGenerous) ? deadline + 1_ns : deadline);
    }

    void run(const Work& work, std::size_t i) noexcept {
        const bool is_forgotten = has(HostFlaw::kForgetsSecondPass) && work.pass == Pass::kStateUpdate;
        if (is_forgotten || (has(HostFlaw::kSkipsStep) && i == 1U)) {
            return;
        }
        const std::size_t place = has(HostFlaw::kRunsBackwards) ? work.count - 1U - i : i;
        const std::size_t number = (has(HostFlaw::kIgnoresFirstNumber) ? 0U : work.first) + place;
        work.run(work.argument, number, number + 1U);
        if (has(HostFlaw::kRunsStepTwice) && i == 0U) {
            work.run(work.argument, number, number + 1U);
        }
    }

    std::size_t cut(const Work& work, std::size_t i, Instant cut_off, const StepPlan& plan) noexcept {
        now_ = has(HostFlaw::kDoesNotCut) ? now_ + plan.time : has(HostFlaw::kCutsTooEarly) ? now_ : cut_off;
        is_hang_out_ = is_hang_out_ || plan.is_hang;
        is_return_forgotten_ = is_hang_out_ && has(HostFlaw::kForgetsReturnOfAHang);
        if (has(HostFlaw::kRunsAbandonedStepLater) && i + 1U < work.count) {
            left_over_ = work;
            left_over_.first = work.first + i + 1U;
            is_left_over_ = true;
        }
        const bool is_one_entered = has(HostFlaw::kEntersOneAbandonedStep) && !plan.is_hang;
        if (is_one_entered || has(HostFlaw::kEntersAllAbandonedSteps)) {
            const Instant answered_at = now_;
            const std::size_t end = is_one_entered ? i + 2U : work.count;
            now_ = step_end_;
            for (std::size_t rest = i + 1U; rest < work.count && rest < end; ++rest) {
                run(work, rest);
            }
            now_ = answered_at;
        }
        return has(HostFlaw::kCountsCutOffStep) ? i + 1U : i;
    }

    void run_left_over(std::size_t window) noexcept {
        if (is_left_over_ && left_over_.window != window) {
            is_left_over_ = false;
            left_over_.run(left_over_.argument, left_over_.first, left_over_.first + 1U);
        }
    }

    HostFlaw flaw_;
    std::vector<StepPlan> plans_;
    Instant now_{};
    Instant step_end_{};
    Work left_over_{};
    bool is_left_over_{false};
    bool is_hang_out_{false};
    bool is_return_forgotten_{false};
};

class ExactHostRig final : public HostRig {
  public:
    explicit ExactHostRig(HostFlaw flaw) : host_(flaw) {}

    Instant get_now() const override { return host_.get_now(); }
    void wait_until(Instant instant) override { host_.advance_to(instant); }
    Duration get_tick() const override { return 1_us; }
    bool is_exact() const override { return true; }
    WindowHost& get_host() override { return host_; }
    void plan(const WindowHost::Work&, const std::vector<StepPlan>& steps) override {
        host_.set_plans(steps);
    }
    void spend(std::size_t, const StepPlan&) noexcept override {}
    void release(std::size_t) noexcept override { host_.release(); }

  private:
    ExactHost host_;
};

}  // namespace mamori::ports::conformance

#endif  // MAMORI_PORTS_CONFORMANCE_TESTS_SUPPORT_EXACT_HOST_HPP
