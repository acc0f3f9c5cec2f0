// SPDX-License-Identifier: Apache-2.0
/// @file
/// A transport between two partitions, as a component of the system table: it passes messages on and can be
/// told to lose or delay them. It is a grey channel: the receiver must judge age and content by itself.
///
/// @satisfies SWR-VTM-004      Design: docs/design/virtual_time.md#channel
#ifndef MAMORI_PORTS_VIRTUAL_TIME_SIMULATED_CHANNEL_HPP
#define MAMORI_PORTS_VIRTUAL_TIME_SIMULATED_CHANNEL_HPP

#include <array>
#include <cstddef>

#include "mamori/kernel/component.hpp"
#include "mamori/kernel/data_port.hpp"
#include "mamori/kernel/system.hpp"

namespace mamori::ports::virtual_time {

/// Faults of a transport, judged worst first: a lost message is not delayed as well.
struct ChannelFault {
    bool is_losing{false};  ///< messages that arrive now are dropped
    Duration delay{0};      ///< messages that arrive now leave this much later; >= 0
};

/// Channel for payload T that can hold `kCapacity` delayed messages; the oldest gives way when it is full.
///
/// Thread safety: none; runs in its window. Time: O(kCapacity). Memory: kCapacity T.
template <typename T, std::size_t kCapacity>
class SimulatedChannel final : public Component {
  public:
    constexpr explicit SimulatedChannel(const char* name) noexcept : Component(name) {}

    InPort<T> in{"in"};
    OutPort<T> out{"out"};
    using Ports = mamori::Ports<&SimulatedChannel::in, &SimulatedChannel::out>;

    /// Takes effect on messages that arrive from the next cycle on.
    void set_fault(const ChannelFault& fault) noexcept { fault_ = fault; }

    Status on_execute(ContextHandle context) noexcept override {
        if (in.is_new() && !fault_.is_losing) {
            store(in.read(), context.now + fault_.delay);
        }
        deliver(context.now);
        return Status::kOk;
    }

  private:
    struct Slot {
        T message{};
        Instant due{};
    };

    void store(const T& message, Instant due) noexcept {
        if (count_ == kCapacity) {
            first_ = (first_ + 1U) % kCapacity;
            --count_;
        }
        slots_[(first_ + count_) % kCapacity] = {message, due};
        ++count_;
    }

    /// Messages leave in the order in which they came, at most one per cycle reaches the latest-value port.
    void deliver(Instant now) noexcept {
        while (count_ > 0U && slots_[first_].due <= now) {
            out.write(slots_[first_].message);
            first_ = (first_ + 1U) % kCapacity;
            --count_;
        }
    }

    std::array<Slot, kCapacity> slots_{};
    std::size_t first_{0U};
    std::size_t count_{0U};
    ChannelFault fault_{};
};

}  // namespace mamori::ports::virtual_time

#endif  // MAMORI_PORTS_VIRTUAL_TIME_SIMULATED_CHANNEL_HPP
