// SPDX-License-Identifier: Apache-2.0
#include "mamori/ports/posix_rt/core_runner.hpp"

#include <limits>

#include "mamori/kernel/base/assert.hpp"

namespace mamori::ports::posix_rt {
namespace {

/// End of `count` major frames from `start`, a multiple of the major frame. At most one major frame before
/// the end of the time line, so that no instant of a window overflows, nor does the search for the next
/// window.
constexpr Instant calc_end(Instant start, Duration frame, std::uint64_t count) noexcept {
    constexpr std::int64_t kLast = std::numeric_limits<std::int64_t>::max();
    const std::int64_t left = (kLast - start.ns) / frame.ns - 1;
    const bool is_short = left > 0 && count < static_cast<std::uint64_t>(left);
    const std::int64_t frames = is_short ? static_cast<std::int64_t>(count) : left;
    return start + frame * (frames > 0 ? frames : 0);
}

}  // namespace

void CoreRunner::run(std::uint64_t frame_count, Instant from) noexcept {
    MAMORI_REQUIRE(1, frame_count > 0U);
    MAMORI_REQUIRE(2, has_publication_margin(executive_.get_view()));
    const std::int64_t frame = executive_.get_view().frame.ns;
    const std::int64_t now = from.ns;
    // Rounds up without the sum, which could overflow.
    const std::int64_t first = now <= 0 ? 0 : (now - 1) / frame + 1;
    if (first > std::numeric_limits<std::int64_t>::max() / frame - 1) {
        return;
    }
    const Instant start{first * frame};
    const Instant end = calc_end(start, Duration{frame}, frame_count);
    FrameSchedule schedule{executive_.get_view(), executive_.get_core(), start};
    while (schedule.get_next().release < end && !is_stopped_before(schedule.get_next().release)) {
        const FrameSchedule::Opening opening = schedule.get_next();
        clock_.wait_until(opening.release);
        if (!is_stopped_before(opening.release)) {
            open(opening);
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
