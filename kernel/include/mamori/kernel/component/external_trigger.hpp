// SPDX-License-Identifier: Apache-2.0
/// @file
/// Counts the ticks that release the cycles of an externally triggered context, for example from a simulator
/// in lockstep, a camera or a test.
///
/// @satisfies SWR-RTC-008      Design: docs/design/rtc_semantics.md#externally-triggered-contexts
#ifndef MAMORI_KERNEL_EXTERNAL_TRIGGER_HPP
#define MAMORI_KERNEL_EXTERNAL_TRIGGER_HPP

#include <atomic>
#include <cstdint>
#include <limits>

namespace mamori {

/// Ticks for one context. Each tick releases one cycle. A window processes at most one tick, so the following
/// windows process the rest of a burst. Every lost tick is counted.
///
/// Thread safety: tick() from any thread or interrupt; the getters from anywhere, with values that may be out
///                of date; the rest from the context that runs the windows.
/// Time:          O(1), wait-free. Memory: no heap.
class ExternalTrigger final {
  public:
    /// @param[in] backlog_limit maximum ticks that wait for a window, 1 .. kLargestLimit, not checked;
    ///                          further ticks overflow. With 0, every tick overflows.
    constexpr explicit ExternalTrigger(std::uint32_t backlog_limit = kLargestLimit) noexcept
        : backlog_limit_(backlog_limit) {}
    ExternalTrigger(const ExternalTrigger&) = delete;
    ExternalTrigger& operator=(const ExternalTrigger&) = delete;

    /// Requests one more cycle.
    void tick() noexcept { arrived_count_.fetch_add(1U, std::memory_order_release); }

    /// Takes one tick; before that, counts the ticks beyond the limit as overflow and drops them. For the
    /// context.
    /// @return true when a tick was taken: a cycle is due.
    bool take() noexcept;
    /// Drops all waiting ticks, because they arrived while the context was Stopped. For the context.
    void ignore_waiting() noexcept;

    /// Ticks that wait for a window, including those that will overflow.
    std::uint32_t get_backlog() const noexcept;
    /// Ticks dropped beyond the limit (wraps at 2^32).
    std::uint32_t get_overflow_count() const noexcept {
        return overflow_count_.load(std::memory_order_relaxed);
    }
    /// Ticks ignored because the context was Stopped (wraps at 2^32).
    std::uint32_t get_ignored_count() const noexcept {
        return ignored_count_.load(std::memory_order_relaxed);
    }

    /// Half of the counter range: the backlog can reach twice this limit before it wraps.
    static constexpr std::uint32_t kLargestLimit = std::numeric_limits<std::uint32_t>::max() / 2U;

  private:
    /// Both counters wrap at 2^32; only their difference is used.
    std::atomic<std::uint32_t> arrived_count_{0U};
    std::atomic<std::uint32_t> settled_count_{0U};  ///< served, overflowed or ignored
    std::atomic<std::uint32_t> overflow_count_{0U};
    std::atomic<std::uint32_t> ignored_count_{0U};
    std::uint32_t backlog_limit_;
};

}  // namespace mamori

#endif  // MAMORI_KERNEL_EXTERNAL_TRIGGER_HPP
