// SPDX-License-Identifier: Apache-2.0
/// @file
/// Bounded queue of events between any number of senders and the context that processes the events.
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

/// One cell of the queue. `turn` is stored relative to the index of the cell, so that its initial value is
/// zero.
struct FsmEventCell {
    std::atomic<std::uint32_t> turn{0U};
    std::uint32_t epoch{0U};  ///< epoch of the sender: see FsmEventQueue::get_epoch()
    FsmEvent event{};
};

/// First-in first-out queue in cells that its owner provides.
///
/// Thread safety: post() from any thread or interrupt; take() and clear() from one context; the counters from
///                anywhere. Events of one sender stay in order. Events of senders on different cores are in
///                order of arrival.
/// Time:          O(1); post() retries when another sender was faster, at most once per such sender and with
///                at most capacity + 1 attempts. clear() and the take() after it are O(capacity). Nothing
///                blocks.
/// Memory:        no heap; the cells must outlive the queue.
class FsmEventQueue final {
  public:
    /// @param[in] cells 2 .. 2^31, a power of two; any other number is a contract violation at the first use.
    constexpr explicit FsmEventQueue(Span<FsmEventCell> cells) noexcept : cells_(cells) {}
    FsmEventQueue(const FsmEventQueue&) = delete;
    FsmEventQueue& operator=(const FsmEventQueue&) = delete;

    /// Appends an event.
    /// @return kOk; kOutOfResources (full, or more senders were faster than there are cells); the rejected
    ///         event is counted, and nothing is overwritten.
    Status post(const FsmEvent& event) noexcept { return post(event, get_epoch()); }
    /// As above, for a sender that reads the epoch before it decides to send. If the queue was cleared after
    /// that, the event is accepted here and dropped later. @param[in] epoch from get_epoch().
    Status post(const FsmEvent& event, std::uint32_t epoch) noexcept;
    /// Number of calls of clear() (wraps at 2^32). From any thread or interrupt.
    std::uint32_t get_epoch() const noexcept { return epoch_.load(std::memory_order_acquire); }
    /// Takes the oldest event.
    /// @return the event; kPreconditionNotMet (empty, or the sender of the oldest event has not yet filled
    ///         its cell; then the later events wait).
    Result<FsmEvent> take() noexcept;
    /// Starts a new epoch: drops all waiting events, and those that a sender with an older epoch appends
    /// later.
    void clear() noexcept;

    std::size_t get_capacity() const noexcept { return cells_.size(); }
    /// Number of waiting events; may be out of date.
    std::size_t get_size() const noexcept;
    /// Maximum number of events that waited at a post(), 0 .. capacity.
    std::size_t get_high_water_mark() const noexcept { return high_water_.load(std::memory_order_relaxed); }
    /// Number of events that post() rejected (wraps at 2^32).
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
