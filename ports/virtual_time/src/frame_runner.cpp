// SPDX-License-Identifier: Apache-2.0
#include "mamori/ports/virtual_time/frame_runner.hpp"

#include <algorithm>

#include "mamori/kernel/run/executives.hpp"
#include "mamori/ports/virtual_time/preemption.hpp"

namespace mamori::ports::virtual_time {

void FrameRunner::pair_cores() noexcept {
    for (SimulatedCore& core : cores_) {
        const Executive& executive = core.executive_;
        const std::size_t ordinary =
            mamori::detail::find_background_of(executive.get_view(), executive.get_core());
        for (const SimulatedCore& other : cores_) {
            core.ordinary_ = other.executive_.get_core() == ordinary ? &other : core.ordinary_;
        }
    }
}

SimulatedCore& FrameRunner::find_next() noexcept {
    SimulatedCore* best = &cores_[0];
    for (SimulatedCore& core : cores_) {
        if (core.schedule_.get_next().release < best->schedule_.get_next().release) {
            best = &core;
        }
    }
    return *best;
}

WindowOutcome FrameRunner::open(SimulatedCore& core, const FrameSchedule::Opening& opening) noexcept {
    if (core.ordinary_ == nullptr) {
        core.clock_.advance_to(opening.release);
        return core.executive_.run_window(opening.window, opening.release, core.host_);
    }
    const SimulatedCore& ordinary = *core.ordinary_;
    const WindowRow& row = core.executive_.get_view().windows[opening.window];
    Preemption preemption{ordinary.executive_, ordinary.clock_, ordinary.schedule_, row.execution_budget};
    const Instant busy_until = ordinary.clock_.get_now();
    core.clock_.advance_to(preemption.calc_start(std::max(opening.release, busy_until)));
    core.clock_.set_processor(&preemption);
    const WindowOutcome outcome = core.executive_.run_window(opening.window, opening.release, core.host_);
    core.clock_.set_processor(nullptr);
    return outcome;
}

void FrameRunner::run_frame() noexcept {
    const Duration length = cores_[0].executive_.get_view().frame;
    const Instant start{static_cast<std::int64_t>(frame_count_) * length.ns};
    const Instant end = start + length;
    for (SimulatedCore& core : cores_) {
        core.clock_.advance_to(start);
    }
    devices_.sample(frame_count_, start);
    for (SimulatedCore* core = &find_next(); core->schedule_.get_next().release < end; core = &find_next()) {
        const FrameSchedule::Opening opening = core->schedule_.get_next();
        core->schedule_.advance();
        overrun_count_ += open(*core, opening) == WindowOutcome::kOverrun ? 1U : 0U;
    }
    for (SimulatedCore& core : cores_) {
        core.clock_.advance_to(end);
    }
    devices_.apply(frame_count_, start, length);
    ++frame_count_;
}

}  // namespace mamori::ports::virtual_time
