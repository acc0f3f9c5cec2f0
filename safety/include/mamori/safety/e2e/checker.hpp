// SPDX-License-Identifier: Apache-2.0
/// @file
/// The receiving end of a channel: tells good frames from all others, and counts what became of each.
///
/// @satisfies SWR-E2E-004, SWR-E2E-005, SWR-E2E-009      Design: docs/design/e2e.md#causes
#ifndef MAMORI_SAFETY_E2E_CHECKER_HPP
#define MAMORI_SAFETY_E2E_CHECKER_HPP

#include <cstddef>
#include <cstdint>

#include "mamori/kernel/base/span.hpp"
#include "mamori/safety/e2e/channel.hpp"
#include "mamori/safety/e2e/check_status.hpp"
#include "mamori/safety/e2e/frame_cause.hpp"
#include "mamori/safety/e2e/hardened_sequence.hpp"

namespace mamori::safety {

/// Cause of what the order of frames says of a whole frame.
constexpr FrameCause to_cause(CheckStatus status) noexcept {
    if (is_usable(status)) {
        return FrameCause::kGood;
    }
    if (status == CheckStatus::kRepeated) {
        return FrameCause::kRepeated;
    }
    return status == CheckStatus::kWrongSequence ? FrameCause::kOutOfOrder : FrameCause::kInitial;
}

/// Receiving end of one channel.
/// @tparam Profile E2eProfile01<> .. E2eProfile44<>.
/// @tparam Order   Profile::Sequence: CONFORMANT, judges as AUTOSAR does; HardenedSequence: HARDENED, refuses
/// the past.
/// @tparam Source  Profile::Channel, kept in the object; a port takes ConstantChannel.
///
/// Thread safety: none; one per receiver. Time: O(length of the frame). Memory: channel, limits, counts; no
/// heap.
template <typename Profile, typename Order = typename Profile::Sequence,
          typename Source = typename Profile::Channel>
class E2eChecker final {
  public:
    using Channel = typename Profile::Channel;
    using Limits = typename Order::Limits;

    /// @param[in] channel, limits with a fault they are kept, and refuse every frame.
    constexpr E2eChecker(const Source& channel, const Limits& limits) noexcept
        : channel_(channel), order_(limits, Profile::kCounterMax) {
        if (Profile::find_fault(channel) != ChannelFault::kNone ||
            Order::find_fault(limits, Profile::kCounterMax) != ChannelFault::kNone) {
            is_ready_ = false;
        }
    }

    /// Checks a frame that has just come. It is read only, and may be of any length, also none.
    /// @return status; the content may be used where is_usable() says so. kError also for refused channel or
    /// limits.
    constexpr CheckStatus check(Span<const std::byte> frame) noexcept {
        if (!is_ready_) {
            note(FrameCause::kNotReady);
            return CheckStatus::kError;
        }
        std::uint32_t counter = 0U;
        FrameCause cause = Profile::judge_length(channel_, frame.size());
        if (cause == FrameCause::kGood) {
            cause = Profile::read(channel_, frame, counter);
        }
        if (cause != FrameCause::kGood) {
            order_.note_fault();
            note(refine(cause, frame));
            return CheckStatus::kError;
        }
        const CheckStatus status = order_.judge(counter);
        note(to_cause(status));
        return status;
    }

    /// A check in whose period no frame came. @return kNoNewData.
    constexpr CheckStatus check_silence() noexcept {
        order_.note_silence();
        note(FrameCause::kSilence);
        return CheckStatus::kNoNewData;
    }

    /// Finds the order anew, as after construction; counts go on. Only for a deliberate reset.
    constexpr void restart() noexcept {
        order_.restart();
        saturating_increment(restart_count_);
    }

    /// What became of the last check; kSilence before the first.
    constexpr FrameCause get_cause() const noexcept { return cause_; }
    /// How often `cause` came; stops at the greatest value.
    constexpr std::uint32_t get_count(FrameCause cause) const noexcept {
        return counts_[static_cast<std::size_t>(cause)];
    }
    /// How often restart() was called.
    constexpr std::uint32_t get_restart_count() const noexcept { return restart_count_; }
    /// The order of frames: losses, and with HARDENED how often a baseline was made.
    constexpr const Order& get_order() const noexcept { return order_; }

  private:
    constexpr void note(FrameCause cause) noexcept {
        cause_ = cause;
        saturating_increment(counts_[static_cast<std::size_t>(cause)]);
    }

    Source channel_;
    Order order_;
    FrameCounts counts_{};
    std::uint32_t restart_count_{0U};
    FrameCause cause_{FrameCause::kSilence};
    bool is_ready_{true};
};

/// Receiving end that refuses the past.
template <typename Profile>
using HardenedE2eChecker = E2eChecker<Profile, HardenedSequence>;

}  // namespace mamori::safety

#endif  // MAMORI_SAFETY_E2E_CHECKER_HPP
