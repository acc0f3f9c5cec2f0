// SPDX-License-Identifier: Apache-2.0
#include "mamori/ports/virtual_time/frame_runner.hpp"

namespace mamori::ports::virtual_time {

SimulatedCore& FrameRunner::find_next() noexcept {
    SimulatedCore* best = &cores_[0];
    for (SimulatedCore& core : cores_) {
        if (core.schedule_.get_next().release < best->schedule_.get_next().release) {
            best = &core;
        }
    }
    return *best;
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
        core->clock_.advance_to(opening.release);
        if (core->executive_.run_window(opening.window, opening.release, core->host_) ==
            WindowOutcome::kOverrun) {
            ++overrun_count_;
        }
    }
    for (SimulatedCore& core : cores_) {
        core.clock_.advance_to(end);
    }
    devices_.apply(frame_count_, start, length);
    ++frame_count_;
}

}  // namespace mamori::ports::virtual_time
