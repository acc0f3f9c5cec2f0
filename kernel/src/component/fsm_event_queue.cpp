// SPDX-License-Identifier: Apache-2.0
#include "mamori/kernel/component/detail/fsm_event_queue.hpp"

namespace mamori {
namespace {

/// Index of the cell of a position. Positions wrap at 2^32; a power of two as capacity keeps the order.
std::uint32_t calc_index(std::uint32_t position, std::size_t capacity) noexcept {
    MAMORI_REQUIRE(1, capacity > 1U && (capacity & (capacity - 1U)) == 0U);
    return position & static_cast<std::uint32_t>(capacity - 1U);
}

}  // namespace

FsmEventCell& FsmEventQueue::get_cell(std::uint32_t position) const noexcept {
    return cells_[calc_index(position, cells_.size())];
}

// A cell is free for position p when its turn is p. It holds the event of p when its turn is p + 1. It is
// free again for p + capacity, which differs from p + 1 only with two or more cells. The stored turn excludes
// the index of the cell.
std::uint32_t FsmEventQueue::get_turn(const FsmEventCell& cell, std::uint32_t position) const noexcept {
    return cell.turn.load(std::memory_order_acquire) + calc_index(position, cells_.size());
}

void FsmEventQueue::set_turn(FsmEventCell& cell, std::uint32_t position, std::uint32_t turn) noexcept {
    cell.turn.store(turn - calc_index(position, cells_.size()), std::memory_order_release);
}

Status FsmEventQueue::post(const FsmEvent& event, std::uint32_t epoch) noexcept {
    std::uint32_t position = write_position_.load(std::memory_order_relaxed);
    // Each failed exchange is one success of another sender; at most `capacity` of them can succeed.
    for (std::size_t attempt = 0U; attempt <= cells_.size(); ++attempt) {
        FsmEventCell& cell = get_cell(position);
        if (get_turn(cell, position) != position) {
            const std::uint32_t newest = write_position_.load(std::memory_order_relaxed);
            if (newest == position) {
                break;  // the oldest event still occupies the cell
            }
            position = newest;
        } else if (write_position_.compare_exchange_strong(position, position + 1U,
                                                           std::memory_order_relaxed)) {
            cell.event = event;
            cell.epoch = epoch;
            set_turn(cell, position, position + 1U);
            raise_high_water(position + 1U - read_position_.load(std::memory_order_relaxed));
            return Status::kOk;
        }
    }
    refused_.fetch_add(1U, std::memory_order_relaxed);
    return Status::kOutOfResources;
}

/// @return false when there is no event, or its sender has not yet filled its cell.
bool FsmEventQueue::take_front(FsmEvent& event, std::uint32_t& epoch) noexcept {
    const std::uint32_t position = read_position_.load(std::memory_order_relaxed);
    FsmEventCell& cell = get_cell(position);
    if (get_turn(cell, position) != position + 1U) {
        return false;
    }
    event = cell.event;
    epoch = cell.epoch;
    read_position_.store(position + 1U, std::memory_order_relaxed);
    set_turn(cell, position, position + static_cast<std::uint32_t>(cells_.size()));
    return true;
}

Result<FsmEvent> FsmEventQueue::take() noexcept {
    FsmEvent event{};
    std::uint32_t epoch = 0U;
    // Events of an earlier epoch were still in post() when the queue was cleared.
    const std::size_t count = cells_.size() + 1U;
    for (std::size_t i = 0U; i < count && take_front(event, epoch); ++i) {
        if (epoch == epoch_.load(std::memory_order_relaxed)) {
            return event;
        }
    }
    return Status::kPreconditionNotMet;
}

void FsmEventQueue::clear() noexcept {
    // At most the events that are present now; later events are newer than this call.
    const std::size_t count = get_size();
    epoch_.fetch_add(1U, std::memory_order_acq_rel);
    FsmEvent event{};
    std::uint32_t epoch = 0U;
    for (std::size_t i = 0U; i < count && take_front(event, epoch); ++i) {
    }
}

std::size_t FsmEventQueue::get_size() const noexcept {
    const std::uint32_t read = read_position_.load(std::memory_order_relaxed);
    return write_position_.load(std::memory_order_relaxed) - read;
}

void FsmEventQueue::raise_high_water(std::uint32_t size) noexcept {
    // If the reader was faster, the difference is meaningless.
    if (size > cells_.size()) {
        return;
    }
    std::uint32_t highest = high_water_.load(std::memory_order_relaxed);
    // A failed exchange has read a higher mark, and no mark exceeds the capacity.
    while (highest < size) {
        static_cast<void>(high_water_.compare_exchange_strong(highest, size, std::memory_order_relaxed));
    }
}

}  // namespace mamori
