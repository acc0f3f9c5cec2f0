// SPDX-License-Identifier: Apache-2.0
#include "mamori/timing/measuring_host.hpp"

namespace mamori::timing {

void MeasuringHost::measure(void* argument, std::size_t begin, std::size_t end) noexcept {
    const Piece& piece = *static_cast<const Piece*>(argument);
    for (std::size_t step = begin; step < end; ++step) {
        StepRow& row = piece.rows[step - piece.work.first];
        row.start_ns.store(piece.clock->get_now().ns, std::memory_order_relaxed);
        piece.work.run(piece.work.argument, step, step + 1U);
        // A reader that sees an end also sees its start, even in a row that is incomplete when the run is
        // written.
        row.end_ns.store(piece.clock->get_now().ns, std::memory_order_release);
    }
}

std::size_t MeasuringHost::run_within(const Work& work, Instant deadline) noexcept {
    StepRow* const rows = log_.take_steps(current_.release, work.component, work.count, work.pass);
    if (rows == nullptr) {
        return inner_.run_within(work, deadline);
    }
    Piece& piece = pieces_[work.window];
    piece = {&inner_, work, rows};
    Work measured = work;
    measured.run = &MeasuringHost::measure;
    measured.argument = &piece;
    return inner_.run_within(measured, deadline);
}

void MeasuringHost::before_opening(const FrameSchedule::Opening& opening, Instant woke) noexcept {
    if (next_ != nullptr) {
        next_->before_opening(opening, woke);
    }
    current_ = {};
    current_.release = opening.release;
    // The executive reads the clock after the devices; the budget begins then.
    current_.woke = next_ == nullptr ? woke : inner_.get_now();
    current_.window = opening.window;
}

void MeasuringHost::after_opening(const FrameSchedule::Opening& opening, WindowOutcome outcome) noexcept {
    current_.closed = inner_.get_now();
    current_.outcome = outcome;
    log_.add_opening(current_);
    if (next_ != nullptr) {
        next_->after_opening(opening, outcome);
    }
}

}  // namespace mamori::timing
