// SPDX-License-Identifier: Apache-2.0
/// @file
/// A transport between two partitions, as a component of the system table. It forwards messages and can lose
/// or delay them on request. It is a black channel (IEC 61784-3): the receiver must check age and content.
///
/// @satisfies SWR-VTM-004      Design: docs/design/conformance.md#channel
#ifndef MAMORI_PORTS_VIRTUAL_TIME_SIMULATED_CHANNEL_HPP
#define MAMORI_PORTS_VIRTUAL_TIME_SIMULATED_CHANNEL_HPP

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "mamori/kernel/component/component.hpp"
#include "mamori/kernel/dataflow/data_port.hpp"
#include "mamori/kernel/payload/bounded_sequence.hpp"
#include "mamori/kernel/system/system.hpp"

namespace mamori::ports::virtual_time {

/// Injected faults of a transport, worst first: a lost message is not delayed in addition.
struct ChannelFault {
    bool is_losing{false};  ///< discard messages that arrive now
    Duration delay{0};      ///< minimum delay of messages that arrive now; negative: 0
    /// Number of a bit that is inverted in messages that arrive now, counted from their first byte; one
    /// beyond their end begins again at the front. For payloads of bytes.
    std::optional<std::uint32_t> inverted_bit{};
};

namespace detail {

template <std::size_t kCapacity>
void invert_bit(BoundedSequence<std::uint8_t, kCapacity>& bytes, std::uint32_t bit) noexcept {
    if (bytes.size() > 0U) {
        bytes[(bit / 8U) % bytes.size()] ^= static_cast<std::uint8_t>(1U << (bit % 8U));
    }
}
template <typename T>
void invert_bit(T& /*message*/, std::uint32_t /*bit*/) noexcept {}

}  // namespace detail

/// Channel for payload T that stores up to `kCapacity` delayed messages. If it is full, a new message
/// overwrites the oldest. The channel keeps the order: a message without delay waits for earlier delayed
/// messages.
///
/// Thread safety: none; runs in its window. Time: O(kCapacity). Memory: kCapacity T.
template <typename T, std::size_t kCapacity>
class SimulatedChannel final : public Component {
    static_assert(kCapacity > 0U, "a channel holds at least one message");

  public:
    constexpr explicit SimulatedChannel(const char* name) noexcept : Component(name) {}

    InPort<T> in{*this, "in"};
    OutPort<T> out{*this, "out"};
    using Ports = mamori::Ports<&SimulatedChannel::in, &SimulatedChannel::out>;

    /// Takes effect for messages that arrive in the next cycle or later.
    void set_fault(const ChannelFault& fault) noexcept { fault_ = fault; }

    /// Number of messages that newer messages overwrote because the channel was full.
    std::uint32_t get_dropped_count() const noexcept { return dropped_count_; }

    Status on_execute(ContextHandle context) noexcept override {
        if (in.is_new() && !fault_.is_losing) {
            store(in.read(), context.now);
        }
        deliver(context.now);
        return Status::kOk;
    }

  private:
    struct Slot {
        T message{};
        Instant arrival{};
        Duration delay{};
    };

    void store(const T& message, Instant arrival) noexcept {
        if (count_ == kCapacity) {
            drop_first();
            ++dropped_count_;
        }
        Slot& slot = slots_[(first_ + count_) % kCapacity];
        slot = {message, arrival, fault_.delay};
        if (fault_.inverted_bit.has_value()) {
            detail::invert_bit(slot.message, *fault_.inverted_bit);
        }
        ++count_;
    }

    /// Forwards the newest of the due messages, because `out` keeps the latest value only.
    void deliver(Instant now) noexcept {
        while (count_ > 0U && now - slots_[first_].arrival >= slots_[first_].delay) {
            out.write(slots_[first_].message);
            drop_first();
        }
    }

    void drop_first() noexcept {
        first_ = (first_ + 1U) % kCapacity;
        --count_;
    }

    std::array<Slot, kCapacity> slots_{};
    std::size_t first_{0U};
    std::size_t count_{0U};
    std::uint32_t dropped_count_{0U};
    ChannelFault fault_{};
};

}  // namespace mamori::ports::virtual_time

#endif  // MAMORI_PORTS_VIRTUAL_TIME_SIMULATED_CHANNEL_HPP
