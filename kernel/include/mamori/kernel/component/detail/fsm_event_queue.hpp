// SPDX-License-Identifier: Apache-2.0
/// @file
/// Bounded queue of events between whoever sends them and the one context that serves them.
///
/// @satisfies SWR-RTC-009, SWR-RTC-012      Design: docs/design/rtc_semantics.md#event-queue
/// Source:   D. Vyukov, bounded multi-producer queue: each cell tells whose turn it is
#ifndef MAMORI_KERNEL_FSM_EVENT_QUEUE_HPP
#define MAMORI_KERNEL_FSM_EVENT_QUEUE_HPP

#include <atomic>
#include <cstddef>
#include <cstdint>

#include "mamori/kernel/base/span.hpp"
#include "mamori/kernel/base/status.hpp"
#include "mamori/kernel/component/fsm_table.hpp"

namespace mamori {

/// One place of the queue. `turn` is relative to the place's index, so that zero is the start everywhere.
struct FsmEventCell {
    std::atomic<std::uint32_t> turn{0U};
    std::uint32_t epoch{0U};  ///< of the sender, as FsmEventQueue::get_epoch()
    FsmEvent event{};
};

/// First in, first out, over cells given by its owner.
///
/// Thread safety: post() from any thread or interrupt; take() and clear() from one context; counts from
///                anywhere. Events of one sender stay in order; between senders on different cores the order
///                is that of arrival.
/// Time:          O(1); post() tries again when another sender was faster, at most once for each of them and
///                capacity + 1 times in all; clear() is O(capacity), and so is take() after it. Nothing
///                blocks.
/// Memory:        no heap; the cells must outlive the queue.
class FsmEventQueue final {
  public:
    /// @param[in] cells 2 .. 2^31, a power of two; anything else is an own bug at the first use.
    constexpr explicit FsmEventQueue(Span<FsmEventCell> cells) noexcept : cells_(cells) {}
    FsmEventQueue(const FsmEventQueue&) = delete;
    FsmEventQueue& operator=(const FsmEventQueue&) = delete;

    /// Appends an event.
    /// @return kOk; kOutOfResources (full, or more other senders were faster than there are cells): counted,
    ///         nothing is overwritten.
    Status post(const FsmEvent& event) noexcept { return post(event, get_epoch()); }
    /// The same for a sender that has decided on something before: the event is dropped, and not refused,
    /// when the queue was cleared since it asked for the epoch.
    Status post(const FsmEvent& event, std::uint32_t epoch) noexcept;
    /// Counts the calls of clear() (wraps at 2^32). From any thread or interrupt.
    std::uint32_t get_epoch() const noexcept { return epoch_.load(std::memory_order_acquire); }
    /// Takes the oldest event.
    /// @return the event; kPreconditionNotMet (there is none, or its sender has not filled its place yet:
    /// then
    ///         those behind it wait).
    Result<FsmEvent> take() noexcept;
    /// Begins an epoch: what waits is dropped, and what a sender of an earlier epoch still appends.
    void clear() noexcept;

    std::size_t get_capacity() const noexcept { return cells_.size(); }
    /// Events that wait, as of some moment.
    std::size_t get_size() const noexcept;
    /// Most events that ever waited at one post(), 0 .. capacity.
    std::size_t get_high_water_mark() const noexcept { return high_water_.load(std::memory_order_relaxed); }
    /// Events that post() refused (wraps at 2^32).
    std::uint32_t get_refused_count() const noexcept { return refused_.load(std::memory_order_relaxed); }

  private:
    bool take_front(FsmEvent& event, std::uint32_t& epoch) noexcept;
    FsmEventCell& get_cell(std::uint32_t position) const noexcept;
    std::uint32_t get_turn(const FsmEventCell& cell, std::uint32_t position) const noexcept;
    void set_turn(FsmEventCell& cell, std::uint32_t position, std::uint32_t turn) noexcept;
    void raise_high_water(std::uint32_t size) noexcept;

    Span<FsmEventCell> cells_;
    std::atomic<std::uint32_t> write_position_{0U};
    std::atomic<std::uint32_t> read_position_{0U};
    std::atomic<std::uint32_t> high_water_{0U};
    std::atomic<std::uint32_t> refused_{0U};
    std::atomic<std::uint32_t> epoch_{0U};
};

}  // namespace mamori

#endif  // MAMORI_KERNEL_FSM_EVENT_QUEUE_HPP
