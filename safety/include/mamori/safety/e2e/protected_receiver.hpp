// SPDX-License-Identifier: Apache-2.0
/// @file
/// What the safety cycle sees of the receiving end of a protected connection: when the message that was
/// accepted last was sent. protect() of a safety table names it.
///
/// @satisfies SWR-CYC-034      Design: docs/design/safety_cycle.md#protected-connections
#ifndef MAMORI_SAFETY_E2E_PROTECTED_RECEIVER_HPP
#define MAMORI_SAFETY_E2E_PROTECTED_RECEIVER_HPP

#include <cstdint>
#include <type_traits>
#include <utility>

#include "mamori/kernel/base/time.hpp"
#include "mamori/kernel/system/connection_option.hpp"
#include "mamori/safety/e2e/port_outcome.hpp"

namespace mamori::safety {

namespace detail {

template <typename Value, typename = void>
inline constexpr bool kHasSendTime = false;
template <typename Value>
inline constexpr bool kHasSendTime<Value, std::void_t<decltype(std::declval<const Value&>().sent_at_ns)>> =
    std::is_same_v<decltype(Value::sent_at_ns), std::int64_t>;

}  // namespace detail

/// Base of a component that receives protected messages.
///
/// Thread safety: none; the component and the safety cycle run in one executive. Time: O(1).
class ProtectedReceiver {
  public:
    /// @return true while the message that was accepted last is as young as `limit` demands; false before the
    ///         first one, and for a message without a member `sent_at_ns`.
    constexpr bool is_fresh(Instant now, FreshWithin limit) const noexcept {
        return has_message_ &&
               judge_age(sent_at_, now, limit.age_max, limit.lead_max) == E2eOutcome::kAccepted;
    }

  protected:
    constexpr ProtectedReceiver() noexcept = default;
    ~ProtectedReceiver() = default;

    /// @param[in] value of an accepted message; its `sent_at_ns` is ContextHandle::now of its sender.
    template <typename Value>
    void record_accepted(const Value& value) noexcept {
        if constexpr (detail::kHasSendTime<Value>) {
            sent_at_ = Instant{value.sent_at_ns};
            has_message_ = true;
        }
    }

  private:
    Instant sent_at_{};
    bool has_message_{false};
};

}  // namespace mamori::safety

#endif  // MAMORI_SAFETY_E2E_PROTECTED_RECEIVER_HPP
