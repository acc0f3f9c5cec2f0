// SPDX-License-Identifier: Apache-2.0
#include "mamori/ports/posix_rt/core_runner.hpp"

#include <limits>

#include "mamori/kernel/base/assert.hpp"

namespace mamori::ports::posix_rt {
namespace {

/// End of `count` frames from `start` on, a multiple of the frame. Held one frame before the end of the time
/// line, so that no instant of a window, nor the search for the next one, overflows.
constexpr Instant calc_end(Instant start, Duration frame, std::uint64_t count) noexcept {
    constexpr std::int64_t kLast = std::numeric_limits<std::int64_t>::max();
    const std::int64_t left = (kLast - start.ns) / frame.ns - 1;
    const bool is_short = left > 0 && count < static_cast<std::uint64_t>(left);
    const std::int64_t frames = is_short ? static_cast<std::int64_t>(count) : left;
    return start + frame * (frames > 0 ? frames : 0);
}

/// Whether the table states a publication margin, if it has a connection between two cores. A connection
/// without windows is the business of initialize(), which rejects it.
bool has_publication_margin(const SystemView& view) noexcept {
    bool leaves_core = false;
    for (const ConnectionRow& row : view.connections) {
        const bool is_joined = row.source_window != kNoIndex && row.sink_window != kNoIndex;
        leaves_core = leaves_core || (is_joined && view.windows[row.source_window].core !=
                                                       view.windows[row.sink_window].core);
    }
    return !leaves_core || view.publication_margin > Duration{0};
}

}  // namespace

void CoreRunner::run(std::uint64_t frame_count) noexcept {
    MAMORI_REQUIRE(1, frame_count > 0U);
    MAMORI_REQUIRE(2, has_publication_margin(executive_.get_view()));
    const std::int64_t frame = executive_.get_view().frame.ns;
    const std::int64_t now = clock_.get_now().ns;
    // Rounded up without the sum, which could overflow.
    const std::int64_t first = now <= 0 ? 0 : (now - 1) / frame + 1;
    if (first > std::numeric_limits<std::int64_t>::max() / frame - 1) {
        return;
    }
    const Instant start{first * frame};
    const Instant end = calc_end(start, Duration{frame}, frame_count);
    FrameSchedule schedule{executive_.get_view(), executive_.get_core(), start};
    while (schedule.get_next().release < end && !is_stop_wanted_.load(std::memory_order_relaxed)) {
        clock_.wait_until(schedule.get_next().release);
        if (!is_stop_wanted_.load(std::memory_order_relaxed)) {
            open(schedule.get_next());
        }
        schedule.advance();
    }
}

void CoreRunner::open(const FrameSchedule::Opening& opening) noexcept {
    const Instant woke = clock_.get_now();
    const Duration lateness = woke - opening.release;
    if (observer_ != nullptr) {
        observer_->before_opening(opening, woke);
    }
    const WindowOutcome outcome = executive_.run_window(opening.window, opening.release, host_);
    if (observer_ != nullptr) {
        observer_->after_opening(opening, outcome);
    }
    ++counts_.opened;
    counts_.overran += outcome == WindowOutcome::kOverrun ? 1U : 0U;
    counts_.missed += outcome == WindowOutcome::kMissed ? 1U : 0U;
    counts_.worst_lateness = lateness > counts_.worst_lateness ? lateness : counts_.worst_lateness;
}

}  // namespace mamori::ports::posix_rt
