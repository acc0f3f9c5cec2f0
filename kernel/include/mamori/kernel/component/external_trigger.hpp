// SPDX-License-Identifier: Apache-2.0
/// @file
/// Counts the ticks that release the cycles of an externally triggered context: lockstep with a simulator,
/// a camera's frame signal, a test that steps by hand.
///
/// @satisfies SWR-RTC-008      Design: docs/design/rtc_semantics.md#externally-triggered-contexts
#ifndef MAMORI_KERNEL_EXTERNAL_TRIGGER_HPP
#define MAMORI_KERNEL_EXTERNAL_TRIGGER_HPP

#include <atomic>
#include <cstdint>
#include <limits>

namespace mamori {

/// Ticks on their way to one context. Each tick is worth one cycle; a window serves one tick at most, so a
/// burst is worked off in the windows that follow. No tick is lost without being counted.
///
/// Thread safety: tick() from any thread or interrupt; the rest from the context that runs the windows, the
///                getters from anywhere, as of some moment between two calls.
/// Time:          O(1), wait-free. Memory: no heap.
class ExternalTrigger final {
  public:
    /// @param[in] backlog_limit ticks that may wait for a window, 1 .. kLargestLimit, which is not checked;
    ///                          later ones overflow. With 0 every tick overflows.
    constexpr explicit ExternalTrigger(std::uint32_t backlog_limit = kLargestLimit) noexcept
        : backlog_limit_(backlog_limit) {}
    ExternalTrigger(const ExternalTrigger&) = delete;
    ExternalTrigger& operator=(const ExternalTrigger&) = delete;

    /// Asks for one more cycle.
    void tick() noexcept { arrived_count_.fetch_add(1U, std::memory_order_release); }

    /// Takes one tick; ticks beyond the limit are counted as overflow first. For the context.
    /// @return true when there was one: a cycle is due.
    bool take() noexcept;
    /// Drops what waits: ticks that came while the context was Stopped are ignored. For the context.
    void ignore_waiting() noexcept;

    /// Ticks that wait for a window, before any overflow is taken off.
    std::uint32_t get_backlog() const noexcept;
    /// Ticks dropped beyond the limit (wraps at 2^32).
    std::uint32_t get_overflow_count() const noexcept {
        return overflow_count_.load(std::memory_order_relaxed);
    }
    /// Ticks ignored because the context was Stopped (wraps at 2^32).
    std::uint32_t get_ignored_count() const noexcept {
        return ignored_count_.load(std::memory_order_relaxed);
    }

    /// Half of the range of a count: as many ticks again can wait before a backlog wraps.
    static constexpr std::uint32_t kLargestLimit = std::numeric_limits<std::uint32_t>::max() / 2U;

  private:
    /// Both run round at 2^32; only their difference counts.
    std::atomic<std::uint32_t> arrived_count_{0U};
    std::atomic<std::uint32_t> settled_count_{0U};  ///< served, overflowed or ignored
    std::atomic<std::uint32_t> overflow_count_{0U};
    std::atomic<std::uint32_t> ignored_count_{0U};
    std::uint32_t backlog_limit_;
};

}  // namespace mamori

#endif  // MAMORI_KERNEL_EXTERNAL_TRIGGER_HPP
