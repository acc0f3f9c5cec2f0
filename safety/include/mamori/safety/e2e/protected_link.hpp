// SPDX-License-Identifier: Apache-2.0
/// @file
/// Both ends of a protected connection as components: other components use unprotected ports. What lies
/// between the ends is not trusted: only an accepted value is forwarded.
///
/// @satisfies SWR-CYC-034      Design: docs/design/safety_cycle.md#protected-connections
#ifndef MAMORI_SAFETY_E2E_PROTECTED_LINK_HPP
#define MAMORI_SAFETY_E2E_PROTECTED_LINK_HPP

#include <cstdint>

#include "mamori/kernel/component/component.hpp"
#include "mamori/kernel/dataflow/data_port.hpp"
#include "mamori/kernel/system/port_list.hpp"
#include "mamori/safety/e2e/hardened_sequence.hpp"
#include "mamori/safety/e2e/in_port.hpp"
#include "mamori/safety/e2e/out_port.hpp"
#include "mamori/safety/e2e/protected_receiver.hpp"
#include "mamori/safety/e2e/sequence.hpp"

namespace mamori::safety {

namespace detail {

constexpr std::uint32_t get_max_delta(const HardenedLimits& limits) noexcept {
    return limits.max_delta;
}
constexpr std::uint32_t get_max_delta(const PlainLimits& limits) noexcept {
    return limits.max_delta;
}
/// It grows with silence.
constexpr std::uint32_t get_max_delta(const SynchronisingLimits& /*limits*/) noexcept {
    return 0U;
}

}  // namespace detail

/// Protects what is new at its input. It runs in the partition of the component that writes the value.
/// @tparam Message an E2eMessage. Thread safety: none. Time: O(length of the frame).
template <typename Message>
class E2eSender final : public Component {
  public:
    /// @param[in] name static storage.
    constexpr explicit E2eSender(const char* name) noexcept : Component(name) {}

    InPort<typename Message::Value> in{*this, "in"};
    OutPort<typename Message::Frame> out{*this, "out"};
    using Ports = mamori::Ports<&E2eSender::in, &E2eSender::out>;

    /// @return kOk, or the status of E2eOutPort::write().
    Status on_execute(ContextHandle /*context*/) noexcept override {
        return in.is_new() ? protected_.write(in.read()) : Status::kOk;
    }

  private:
    E2eOutPort<Message> protected_{out};
};

/// Forwards the value of each accepted message; `out` gets nothing else.
/// @tparam Message an E2eMessage. @tparam kLimits constexpr E2eInLimits of static storage.
///
/// Thread safety: none. Time and memory: as E2eInPort.
template <typename Message, const auto& kLimits>
class E2eReceiver final : public Component, public ProtectedReceiver {
  public:
    using Value = typename Message::Value;
    static constexpr std::uint8_t kProfile = Message::Profile::kNumber;
    /// Largest accepted step of the counter; 0: no constant.
    static constexpr std::uint32_t kMaxDelta = detail::get_max_delta(kLimits.order);

    /// @param[in] name static storage.
    constexpr explicit E2eReceiver(const char* name) noexcept : Component(name) {}

    InPort<typename Message::Frame> in{*this, "in"};
    OutPort<Value> out{*this, "out"};
    using Ports = mamori::Ports<&E2eReceiver::in, &E2eReceiver::out>;

    /// @return kOk, with any content of the messages.
    Status on_execute(ContextHandle context) noexcept override {
        Value value{};
        if (protected_.read(context.now, value) == E2eWorth::kNew) {
            record_accepted(value);
            out.write(value);
        }
        return Status::kOk;
    }
    /// How often `outcome` came; stops at the largest value.
    std::uint32_t get_count(E2eOutcome outcome) const noexcept { return protected_.get_count(outcome); }

  private:
    static constexpr Value kNothing{};
    E2eInPort<Message, kLimits> protected_{in, kNothing};
};

}  // namespace mamori::safety

#endif  // MAMORI_SAFETY_E2E_PROTECTED_LINK_HPP
