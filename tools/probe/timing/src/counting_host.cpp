// SPDX-License-Identifier: Apache-2.0
#include "mamori/timing/counting_host.hpp"

[[gnu::noinline]] void mamori_counted_step(void (*run)(void* argument, std::size_t begin,
                                                       std::size_t end) noexcept,
                                           void* argument, std::size_t step) noexcept {
    run(argument, step, step + 1U);
    // Without this, the call becomes a jump, and the function ends before the step begins.
    asm volatile("" : : : "memory");
}

namespace mamori::timing {
namespace {

/// Planned start of the window that contains the instant `now`.
Instant calc_release(const WindowRow& window, Instant now) noexcept {
    const Duration since = now - (Instant{} + window.offset);
    return Instant{} + window.offset + Duration{since.ns / window.period.ns * window.period.ns};
}

}  // namespace

void CountingHost::count(void* argument, std::size_t begin, std::size_t end) noexcept {
    const Piece& piece = *static_cast<const Piece*>(argument);
    for (std::size_t step = begin; step < end; ++step) {
        StepRow& row = piece.rows[step - piece.work.first];
        row.start_ns.store(piece.clock->get_now().ns, std::memory_order_relaxed);
        mamori_counted_step(piece.work.run, piece.work.argument, step);
        row.end_ns.store(piece.clock->get_now().ns, std::memory_order_relaxed);
    }
}

std::size_t CountingHost::run_within(const Work& work, Instant deadline) noexcept {
    const Instant now = inner_.get_now();
    if (is_paced_) {
        clock_.wait_until(now);
    }
    if (!cycles_.has(static_cast<std::uint64_t>(now.ns / view_.frame.ns))) {
        return inner_.run_within(work, deadline);
    }
    StepRow* const rows =
        log_.take_steps(calc_release(view_.windows[work.window], now), work.component, work.count, work.pass);
    if (rows == nullptr) {
        return inner_.run_within(work, deadline);
    }
    Piece& piece = pieces_[work.window];
    piece = {&clock_, work, rows};
    Work counted = work;
    counted.run = &CountingHost::count;
    counted.argument = &piece;
    return inner_.run_within(counted, deadline);
}

}  // namespace mamori::timing
