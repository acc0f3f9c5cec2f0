// SPDX-License-Identifier: Apache-2.0
/// @file
/// The receiving end of a protected message, behind an ordinary input of the kernel. A value comes out only
/// when its frame, its content, its age and the state of the channel allow it; else a substitute does.
///
/// @satisfies SWR-E2E-031, SWR-E2E-032, SWR-E2E-033, SWR-E2E-034, SWR-E2E-035
/// @satisfies SWR-E2E-037, SWR-E2E-039, SWR-E2E-041, SWR-E2E-042
/// Design:   docs/design/e2e.md#ports
#ifndef MAMORI_SAFETY_E2E_IN_PORT_HPP
#define MAMORI_SAFETY_E2E_IN_PORT_HPP

#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "mamori/kernel/base/span.hpp"
#include "mamori/kernel/base/status.hpp"
#include "mamori/kernel/base/time.hpp"
#include "mamori/kernel/dataflow/data_port.hpp"
#include "mamori/kernel/payload/cdr.hpp"
#include "mamori/safety/base/saturating_increment.hpp"
#include "mamori/safety/e2e/check_status.hpp"
#include "mamori/safety/e2e/checker.hpp"
#include "mamori/safety/e2e/frame.hpp"
#include "mamori/safety/e2e/frame_source.hpp"
#include "mamori/safety/e2e/message.hpp"
#include "mamori/safety/e2e/port_outcome.hpp"
#include "mamori/safety/e2e/stamped.hpp"
#include "mamori/safety/e2e/state_machine.hpp"

namespace mamori::safety {

/// What a receiving port demands.
/// @tparam Order Profile::Sequence: CONFORMANT; HardenedSequence: HARDENED.
template <typename Order>
struct E2eInLimits {
    using Sequence = Order;

    Duration age_max{};              ///< greatest age of a value that is handed out, > 0
    typename Order::Limits order{};  ///< of the counter
    std::size_t window{1U};          ///< readings that the state of the channel looks back on, 1 .. 255
    ChannelDemands demands{};        ///< on these
    MappingRule rule{MappingRule::kSyncIsOk};
    Duration lead_max{};  ///< how far the instant of a value may be after now, >= 0
};

/// Receives values of a message. The input stands in the component's list of ports, this beside it:
///     mamori::InPort<SafeSpeed::Frame> in{*this, "speed"};
///     mamori::safety::E2eInPort<SafeSpeed, kLimits> speed{in, kStandstill};
///
/// Call read() in every cycle of the component, as this is how silence is seen.
///
/// @tparam Message an E2eMessage.
/// @tparam kLimits constexpr E2eInLimits, of static storage duration; unsound ones do not compile.
/// @tparam Port    the kernel's input, InPort or QueueInPort, whose payload is an E2eFrame with room for the
///                 message.
///
/// Thread safety: none; belongs to the component of the input. Time: O(length of the frame + window).
/// Memory: the limits' window, two values, and with a queue one frame; no heap.
template <typename Message, const auto& kLimits, typename Port = InPort<typename Message::Frame>>
class E2eInPort final {
  public:
    using Value = typename Message::Value;
    using Profile = typename Message::Profile;
    using Order = typename std::remove_reference_t<decltype(kLimits)>::Sequence;
    using Checker = E2eChecker<Profile, Order, ConstantChannel<Message::kChannel>>;

    static_assert(ChannelIsSound<Order::find_fault(kLimits.order, Profile::kCounterMax)>::value);
    static_assert(are_sound(kLimits.demands, kLimits.window), "demands on the channel's window are unsound");
    static_assert(kLimits.age_max > Duration{0}, "a value needs an age that it may reach");
    static_assert(kLimits.lead_max >= Duration{0}, "the tolerance for instants to come is not negative");
    static_assert(Port::Payload::capacity() >= Message::kLengthMax,
                  "frames of the port have no room for the message");

    /// @param[in] port       must outlive this object; nobody else reads it.
    /// @param[in] substitute what is handed out when no value may be used: safe for its user at any time.
    constexpr E2eInPort(Port& port, const Value& substitute) noexcept
        : source_(port), substitute_(substitute), value_(substitute) {}
    E2eInPort(const E2eInPort&) = delete;
    E2eInPort& operator=(const E2eInPort&) = delete;

    /// Checks the frame that has come, or notes that none has. Once in each cycle; while has_frame() says so
    /// after that, once more for each frame that a queue still holds.
    /// @param[in]  now   ContextHandle::now of the cycle.
    /// @param[out] value always written: never anything but a value that may be used now, or the substitute.
    /// @return which of them it is.
    [[nodiscard]] E2eWorth read(Instant now, Value& value) noexcept {
        if (source_.get_restart_count() != restart_count_) {
            restart_count_ = source_.get_restart_count();
            source_.forget();
            has_value_ = false;  // whatever this reading brings: what is held is of another mode or run
            forget_waiting();
        }
        E2eOutcome outcome = judge_reading(now);
        if (!machine_.is_valid()) {
            has_value_ = false;
        }
        if (outcome == E2eOutcome::kAccepted && !has_value_) {
            outcome = E2eOutcome::kUnproven;
        }
        outcome_ = outcome;
        saturating_increment(counts_[static_cast<std::size_t>(outcome)]);
        if (outcome == E2eOutcome::kAccepted) {
            value = value_;
            return E2eWorth::kNew;
        }
        if (has_value_ && judge(origin_, now) == E2eOutcome::kAccepted) {
            value = value_;
            return E2eWorth::kHeld;
        }
        value = substitute_;
        return E2eWorth::kSubstitute;
    }

    /// True when a frame waits that no reading has seen.
    bool has_frame() noexcept { return source_.has_frame(); }

    /// Forgets value, order and state; counts go on. Only for a deliberate reset.
    void restart() noexcept {
        checker_.restart();
        machine_.restart();  // and the next reading drops the value
        forget_waiting();
    }

    /// What became of the last reading; kSilent before the first.
    E2eOutcome get_outcome() const noexcept { return outcome_; }
    /// How often `outcome` came; stops at the greatest value.
    std::uint32_t get_count(E2eOutcome outcome) const noexcept {
        return counts_[static_cast<std::size_t>(outcome)];
    }
    /// Cause of the last check and how often each came.
    const Checker& get_checker() const noexcept { return checker_; }
    ChannelState get_state() const noexcept { return machine_.get_state(); }

  private:
    /// Only a stamp can be later than the planned start of a window of the same system.
    static constexpr bool kMayWait = detail::kIsStamped<Value>;

    bool has_waiting() const noexcept { return kMayWait && waiting_ != CheckStatus::kNoNewData; }
    void forget_waiting() noexcept {
        if constexpr (kMayWait) {
            waiting_ = CheckStatus::kNoNewData;
        }
    }
    /// Checks the new message, or takes the one that waits, or records that none has come.
    E2eOutcome judge_reading(Instant now) noexcept {
        if (has_frame()) {
            const Span<const std::byte> frame = detail::view_bytes(source_.take());
            const CheckStatus status = checker_.check(frame);
            if (is_usable(status)) {
                return open(frame, status, now);
            }
            forget_waiting();
            note(to_profile_status(status, kLimits.rule));
            return E2eOutcome::kRefused;
        }
        if (has_waiting()) {
            return open(detail::view_bytes(source_.get_taken()), waiting_, now);
        }
        static_cast<void>(checker_.check_silence());
        note(ProfileStatus::kNoNewData);
        return E2eOutcome::kSilent;
    }
    /// Takes the value out of a message that the check accepted. What was held before is older, and is
    /// dropped with a message that is not for use. A reader that is released late may find a message that was
    /// sent after the planned start of its window: it waits for the next reading, unless one waited before.
    /// @return kAccepted, kMalformed, kEarly or kLate.
    E2eOutcome open(Span<const std::byte> frame, CheckStatus status, Instant now) noexcept {
        const Span<const std::byte> payload =
            frame.subspan(Message::kPayloadAt, frame.size() - Message::kPayloadAt);
        const Instant origin =
            detail::read_origin<Value>(payload, Message::kByteOrder, source_.get_published_at());
        if (kMayWait && !has_waiting() && judge(origin, now) == E2eOutcome::kEarly) {
            waiting_ = status;
            note(ProfileStatus::kNoNewData);
            return E2eOutcome::kEarly;
        }
        forget_waiting();
        E2eOutcome outcome = E2eOutcome::kMalformed;
        if (decode(payload, Message::kByteOrder, value_) == Status::kOk) {
            origin_ = origin;
            outcome = judge(origin, now);
        }
        has_value_ = outcome == E2eOutcome::kAccepted;
        note(has_value_ ? ProfileStatus::kOk : ProfileStatus::kError);
        return outcome;
    }
    static constexpr E2eOutcome judge(Instant origin, Instant now) noexcept {
        return judge_age(origin, now, kLimits.age_max, kLimits.lead_max);
    }
    void note(ProfileStatus status) noexcept {
        static_cast<void>(machine_.check(status));  // its demands are sound
    }

    detail::FrameSource<Port> source_;
    Checker checker_{{}, kLimits.order};
    std::array<ProfileStatus, kLimits.window> window_{};
    ChannelStateMachine machine_{window_, kLimits.demands};
    Value substitute_;
    Value value_;
    Instant origin_{};                 ///< from which the age of value_ counts
    std::uint32_t restart_count_{0U};  ///< of the input, as the last reading found it
    E2eOutcomeCounts counts_{};
    E2eOutcome outcome_{E2eOutcome::kSilent};
    CheckStatus waiting_{CheckStatus::kNoNewData};  ///< of the message that waits; kNoNewData: none waits
    bool has_value_{false};
};

}  // namespace mamori::safety

#endif  // MAMORI_SAFETY_E2E_IN_PORT_HPP
