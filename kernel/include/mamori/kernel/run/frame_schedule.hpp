// SPDX-License-Identifier: Apache-2.0
/// @file
/// Order of the window starts of one core over all major frames. Ports obtain the next window and its planned
/// start only from here.
///
/// @satisfies SWR-KRN-027      Design: docs/design/kernel.md#windows
#ifndef MAMORI_KERNEL_FRAME_SCHEDULE_HPP
#define MAMORI_KERNEL_FRAME_SCHEDULE_HPP

#include <cstddef>
#include <cstdint>
#include <limits>

#include "mamori/kernel/table/system_table.hpp"

namespace mamori {

/// Iterates over the window starts of one core in time order. Equal instants cannot occur, since windows are
/// disjoint.
///
/// Thread safety: none. Time: O(windows) per window start; nothing blocks.
/// Memory:        the view, two words and an instant.
class FrameSchedule final {
  public:
    /// One window start.
    struct Opening {
        std::size_t window{kNoIndex};                               ///< kNoIndex: no window runs on this core
        Instant release{std::numeric_limits<std::int64_t>::max()};  ///< planned window start
    };

    /// @param[in] view its table must outlive this object and violate no rule (check()). @param[in] core as
    ///                 WindowRow::core.
    /// @param[in] start the first result is the earliest window start at or after this instant.
    constexpr FrameSchedule(const SystemView& view, std::size_t core, Instant start) noexcept
        : view_(view), core_(core), next_(find(start)) {}

    /// Next window start; does not advance. The reference is valid as long as this object, its value until
    /// advance().
    constexpr const Opening& get_next() const noexcept { return next_; }

    /// Advances to the following window start; no effect if no window runs on this core.
    constexpr void advance() noexcept {
        if (next_.window != kNoIndex) {
            next_ = find(next_.release + Duration{1});
        }
    }

  private:
    constexpr Opening find(Instant from) const noexcept {
        Opening best{};
        for (std::size_t w = 0U; w < view_.windows.size(); ++w) {
            const WindowRow& row = view_.windows[w];
            if (row.core != core_) {
                continue;
            }
            const std::int64_t since = from.ns - row.offset.ns;
            const std::int64_t count = since <= 0 ? 0 : (since + row.period.ns - 1) / row.period.ns;
            const Instant release{row.offset.ns + count * row.period.ns};
            if (release < best.release) {
                best = {w, release};
            }
        }
        return best;
    }

    SystemView view_;
    std::size_t core_;
    Opening next_;
};

}  // namespace mamori

#endif  // MAMORI_KERNEL_FRAME_SCHEDULE_HPP
