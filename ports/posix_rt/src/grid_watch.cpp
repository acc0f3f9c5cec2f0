// SPDX-License-Identifier: Apache-2.0
#include "mamori/ports/posix_rt/grid_watch.hpp"

#include "failure_order.hpp"
#include "mamori/kernel/base/assert.hpp"

namespace mamori::ports::posix_rt {
namespace {

constexpr Duration calc_allowance(const WindowRow& row) noexcept {
    return is_background(row) ? row.length - row.execution_budget : Duration{0};
}

}  // namespace

void GridBeat::expect(Instant from) noexcept {
    const FrameSchedule schedule{view_, core_, from};
    const FrameSchedule::Opening& next = schedule.get_next();
    const Duration allowance =
        next.window == kNoIndex ? Duration{0} : calc_allowance(view_.windows[next.window]);
    due_ns_.store((next.release + allowance).ns, std::memory_order_release);
}

void GridBeat::before_opening(const FrameSchedule::Opening& opening, Instant woke) noexcept {
    if (inner_ != nullptr) {
        inner_->before_opening(opening, woke);
    }
    const WindowRow& row = view_.windows[opening.window];
    const Instant closing = opening.release + row.length + calc_allowance(row);
    due_ns_.store(closing.ns, std::memory_order_release);
}

void GridBeat::after_opening(const FrameSchedule::Opening& opening, WindowOutcome outcome) noexcept {
    if (inner_ != nullptr) {
        inner_->after_opening(opening, outcome);
    }
    expect(opening.release + Duration{1});
}

GridCheck::GridCheck(Span<const GridBeat> beats, const GridLimits& limits) noexcept
    : beats_(beats), lateness_(limits.lateness), rate_(limits.rate) {
    MAMORI_REQUIRE(1, limits.lateness >= Duration{0} && limits.period > Duration{0});
    MAMORI_REQUIRE(2, limits.rate.span > Duration{0} && limits.rate.limit_ppm > 0);
}

GridFinding GridCheck::look(const ClockPair& pair) noexcept {
    const Rate rate = rate_.look(pair);
    if (rate != Rate::kSound) {
        const GridFault fault = rate == Rate::kFast ? GridFault::kFastClock : GridFault::kSlowClock;
        return {fault, kNoIndex, Instant{}, pair.watched};
    }
    for (std::size_t core = 0U; core < beats_.size(); ++core) {
        const Instant due = beats_[core].get_due();
        if (due != GridBeat::kNever && pair.watched > add_saturating(due, lateness_)) {
            rate_.restart();  // the time without a violation begins again
            return {GridFault::kOverdue, core, due, pair.watched};
        }
    }
    return {};
}

GridWatch::GridWatch(Span<const GridBeat> beats, const FrameClock& clock, const ClockReading& reference,
                     const GridLimits& limits, const OutputGate& gate, ThreadPlace place) noexcept
    : clock_(clock),
      reference_(reference),
      period_(limits.period),
      gate_(gate),
      place_(place),
      check_(beats, limits) {
    MAMORI_REQUIRE(3, gate.close != nullptr);
}

Status GridWatch::open() noexcept {
    if (is_open_) {
        return Status::kPreconditionNotMet;
    }
    const int own_priority = get_own_priority();
    if (own_priority != 0 && place_.priority <= own_priority) {
        return Status::kBadParameter;
    }
    detail::install_failure_gate();
    is_ending_.store(false, std::memory_order_relaxed);
    ThreadRights rights;
    if (start_thread(thread_, &GridWatch::serve, this, place_, rights) != Status::kOk) {
        return Status::kOutOfResources;
    }
    is_open_ = true;
    right_ = combine(rights.priority, rights.processor);
    return Status::kOk;
}

void GridWatch::close() noexcept {
    if (is_open_) {
        is_ending_.store(true, std::memory_order_relaxed);
        MAMORI_ENSURE(4, pthread_join(thread_, nullptr) == 0);
        is_open_ = false;
    }
}

Status GridWatch::reset() noexcept {
    if (!is_latched() || !is_sound_.load(std::memory_order_acquire)) {
        return Status::kPreconditionNotMet;
    }
    finding_ = {};
    is_latched_.store(false, std::memory_order_release);
    return Status::kOk;
}

void* GridWatch::serve(void* argument) noexcept {
    static_cast<GridWatch*>(argument)->watch();
    return nullptr;
}

/// Sleeps on CLOCK_MONOTONIC, also if the frame clock has another source.
void GridWatch::watch() noexcept {
    const TimeSource& own = get_monotonic_clock();
    while (!is_ending_.load(std::memory_order_relaxed)) {
        look();
        own.wait_until(add_saturating(Instant{own.read_ns()}, period_).ns);
    }
}

void GridWatch::look() noexcept {
    const GridFinding finding = check_.look(read_pair(clock_, reference_));
    look_count_.fetch_add(1U, std::memory_order_relaxed);
    if (is_latched_.load(std::memory_order_acquire)) {
        is_sound_.store(finding.fault == GridFault::kNone && check_.get_sound_spans() > 0U,
                        std::memory_order_release);
    } else if (finding.fault != GridFault::kNone) {
        gate_.close(gate_.argument);
        finding_ = finding;
        is_sound_.store(false, std::memory_order_relaxed);
        is_latched_.store(true, std::memory_order_release);
    }
}

}  // namespace mamori::ports::posix_rt
