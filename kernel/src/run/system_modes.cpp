// SPDX-License-Identifier: Apache-2.0
#include "mamori/kernel/run/system_modes.hpp"

#include "mamori/kernel/base/assert.hpp"

namespace mamori {
namespace {

constexpr std::uint32_t kNobody = 0xFFFFFFU;

constexpr std::uint32_t encode(const ModeFailure& failure) noexcept {
    const std::uint32_t component =
        failure.component < kNobody ? static_cast<std::uint32_t>(failure.component) : kNobody;
    return static_cast<std::uint32_t>(failure.cause) << 28U |
           static_cast<std::uint32_t>(failure.step) << 24U | component;
}

/// Index of the first transition with this event in mode `source`, or in any mode if `source` is kNoIndex.
std::size_t find_transition(const ModeView& view, std::uint32_t event, std::size_t source) noexcept {
    for (std::size_t i = 0U; i < view.transitions.size(); ++i) {
        const ModeTransitionRow& row = view.transitions[i];
        if (row.event == event && (source == kNoIndex || row.source == source)) {
            return i;
        }
    }
    return kNoIndex;
}

}  // namespace

Status SystemModes::request_event(std::uint32_t event, const std::uint8_t* enumeration) noexcept {
    const std::uint8_t* const known = view_.modes.event_enumeration;
    const bool is_foreign = known != nullptr && known != enumeration;
    if (is_foreign || find_transition(view_.modes, event, kNoIndex) == kNoIndex) {
        return Status::kBadParameter;
    }
    const std::size_t transition = find_transition(view_.modes, event, get_mode());
    if (transition == kNoIndex || get_step() > ModeStep::kSet || is_failing()) {
        return Status::kPreconditionNotMet;
    }
    std::uint32_t none = 0U;
    const bool is_first = request_.compare_exchange_strong(none, static_cast<std::uint32_t>(transition) + 1U,
                                                           std::memory_order_acq_rel);
    return is_first ? Status::kOk : Status::kPreconditionNotMet;
}

Status SystemModes::request_safe_mode() noexcept {
    if (safe_mode_ == kNoIndex) {
        return Status::kUnsupported;
    }
    static_cast<void>(fail({ModeFailureCause::kRequested, get_step(), kNoIndex}));
    return Status::kOk;
}

ModeFailure SystemModes::get_failure() const noexcept {
    const std::uint32_t word = failure_.load(std::memory_order_acquire);
    if (word == 0U) {
        return {};
    }
    const std::uint32_t component = word & kNobody;
    return {static_cast<ModeFailureCause>(word >> 28U), static_cast<ModeStep>(word >> 24U & 0xFU),
            component == kNobody ? kNoIndex : component};
}

Status SystemModes::reset() noexcept {
    if (running_.load(std::memory_order_acquire) != 0U) {
        return Status::kPreconditionNotMet;
    }
    if (!view_.modes.modes.empty()) {
        enter(0U);
    }
    request_.store(0U, std::memory_order_relaxed);
    failure_.store(0U, std::memory_order_release);
    return Status::kOk;
}

bool SystemModes::fail(const ModeFailure& failure) noexcept {
    std::uint32_t none = 0U;
    return failure_.compare_exchange_strong(none, encode(failure), std::memory_order_acq_rel);
}

bool SystemModes::is_failing() const noexcept {
    return safe_mode_ != kNoIndex && failure_.load(std::memory_order_acquire) != 0U;
}

/// For a system in which no core runs: no component has to be deactivated or activated.
void SystemModes::enter_safe_mode_when_failing() noexcept {
    if (is_failing()) {
        enter(safe_mode_);
    }
}

/// Makes this mode the current one. A mode without its own set changes no parameter: the previous set
/// remains, also for cores that start later.
void SystemModes::enter(std::size_t mode) noexcept {
    const std::size_t set = view_.modes.modes[mode].set;
    if (set != kNoIndex) {
        set_.store(static_cast<std::uint32_t>(set), std::memory_order_release);
    }
    mode_.store(mode, std::memory_order_release);
}

/// Makes the set the active one, unless one of its values is rejected; then no core takes any value of it.
/// @return whether the set is active.
bool SystemModes::hold(std::size_t set) noexcept {
    const bool is_accepted = configuration_.judge_set(set).rule == ConfigurationRule::kNone;
    if (is_accepted) {
        set_.store(static_cast<std::uint32_t>(set), std::memory_order_release);
    }
    return is_accepted;
}

Result<std::size_t> SystemModes::prepare() noexcept {
    if (running_.load(std::memory_order_acquire) == 0U) {
        const std::size_t requested = configuration_.take_requested_set();
        if (requested != kNoConfigurationSet && !hold(requested)) {
            return Status::kBadParameter;
        }
        enter_safe_mode_when_failing();
    }
    const std::size_t set = set_.load(std::memory_order_acquire);
    if (set != kNoConfigurationSet && configuration_.judge_set(set).rule != ConfigurationRule::kNone) {
        return Status::kBadParameter;
    }
    return set;
}

Status SystemModes::join(std::size_t core) noexcept {
    if (plan_.load(std::memory_order_acquire) != 0U) {
        return Status::kPreconditionNotMet;
    }
    finished_[core].store(0U, std::memory_order_relaxed);
    static_cast<void>(running_.fetch_or(1U << core, std::memory_order_acq_rel));
    return Status::kOk;
}

void SystemModes::leave(std::size_t core) noexcept {
    const std::uint32_t own = 1U << core;
    if ((running_.load(std::memory_order_acquire) & own) == 0U) {
        return;
    }
    const ModePlan plan{plan_.load(std::memory_order_acquire)};
    const ModeStep step = plan.get_step();
    if (step == ModeStep::kLeave || step == ModeStep::kEnter) {
        static_cast<void>(fail({ModeFailureCause::kStopped, step, kNoIndex}));
    }
    if (running_.fetch_and(~own, std::memory_order_acq_rel) != own) {
        return;
    }
    // No core is left to execute a step, and all components are Inactive. The next start continues from here.
    if (step == ModeStep::kSet) {
        static_cast<void>(hold(plan.get_index()));
    }
    enter_safe_mode_when_failing();
    request_.store(0U, std::memory_order_relaxed);
    // No core joins while there is a plan. If a core runs, the current plan is therefore a plan of that core.
    const ModePlan last{plan_.load(std::memory_order_acquire)};
    if (running_.load(std::memory_order_acquire) == 0U) {
        replace(last, {});
    }
}

bool SystemModes::is_lead(std::size_t core) const noexcept {
    const std::uint32_t running = running_.load(std::memory_order_acquire);
    return (running & (1U << core)) != 0U && (running & ((1U << core) - 1U)) == 0U;
}

bool SystemModes::is_finished(ModePlan plan) const noexcept {
    const std::uint32_t running = running_.load(std::memory_order_acquire);
    for (std::size_t core = 0U; core < kModeCoreMax; ++core) {
        if ((running & (1U << core)) != 0U &&
            finished_[core].load(std::memory_order_acquire) != plan.get_word()) {
            return false;
        }
    }
    return true;
}

/// No effect if another core replaced the plan at this moment; that core is then responsible.
void SystemModes::replace(ModePlan old, ModePlan next) noexcept {
    std::uint32_t expected = old.get_word();
    static_cast<void>(plan_.compare_exchange_strong(expected, next.get_word(), std::memory_order_acq_rel));
}

void SystemModes::conclude(ModePlan plan, std::int64_t frame) noexcept {
    const ModeStep step = plan.get_step();
    const std::size_t index = plan.get_index();
    if (!is_finished(plan)) {
        if (step == ModeStep::kSafe) {
            return;  // no safer step exists: wait for its end
        }
        static_cast<void>(fail({ModeFailureCause::kLate, step, kNoIndex}));
    }
    // A core that took a set keeps it, regardless of other failures in this step.
    if (step == ModeStep::kSet) {
        static_cast<void>(hold(index));
    } else if (step == ModeStep::kEnter && view_.modes.modes[index].set != kNoIndex) {
        static_cast<void>(hold(view_.modes.modes[index].set));
    }
    if (step != ModeStep::kSafe && is_failing()) {
        replace(plan, {ModeStep::kSafe, safe_mode_, frame + 1});
        return;
    }
    if (step == ModeStep::kLeave) {
        replace(plan, {ModeStep::kEnter, index, frame + 1});
        return;
    }
    if (step != ModeStep::kSet) {
        enter(index);
    }
    replace(plan, {});
}

/// Most severe first: a failure, then a mode, then a set.
void SystemModes::propose(std::int64_t frame) noexcept {
    if (is_failing()) {
        if (get_mode() != safe_mode_) {
            replace({}, {ModeStep::kSafe, safe_mode_, frame + 1});
        }
        return;
    }
    const std::uint32_t request = request_.exchange(0U, std::memory_order_acq_rel);
    // A request that was made while a switch ended may belong to the previous mode.
    if (request != 0U && view_.modes.transitions[request - 1U].source == get_mode()) {
        const std::size_t target = view_.modes.transitions[request - 1U].target;
        replace({}, {ModeStep::kLeave, target, frame + 1});
        return;
    }
    const std::size_t set = configuration_.take_requested_set();
    if (set != kNoConfigurationSet) {
        replace({}, {ModeStep::kSet, set, frame + 1});
    }
}

/// Whether the failure has waited so long that the coordinator core is treated as failed; call once per major
/// frame.
bool SystemModes::is_failure_unserved(std::size_t core) noexcept {
    const bool is_waiting = is_failing() && get_mode() != safe_mode_;
    unserved_frames_[core] = is_waiting ? unserved_frames_[core] + 1 : 0;
    return unserved_frames_[core] >= kLeadPatience;
}

ModePlan SystemModes::begin_frame(std::size_t core, std::int64_t frame) noexcept {
    const ModePlan plan{plan_.load(std::memory_order_acquire)};
    // If the coordinator core has failed, the other cores must neither remain between two modes nor be kept
    // from the safe mode.
    if (plan.get_step() != ModeStep::kNone) {
        unserved_frames_[core] = 0;
        if (plan.calc_age(frame) >= (is_lead(core) ? kModeStepFrames - 1 : kLeadPatience)) {
            conclude(plan, frame);
        }
    } else if (is_failure_unserved(core) || is_lead(core)) {
        propose(frame);
    }
    return ModePlan{plan_.load(std::memory_order_acquire)};
}

}  // namespace mamori
