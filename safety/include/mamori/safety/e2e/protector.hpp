// SPDX-License-Identifier: Apache-2.0
/// @file
/// The sending end of a channel: writes header, counter and checksum into each frame.
///
/// @satisfies SWR-E2E-003, SWR-E2E-009      Design: docs/design/e2e.md#profiles
#ifndef MAMORI_SAFETY_E2E_PROTECTOR_HPP
#define MAMORI_SAFETY_E2E_PROTECTOR_HPP

#include <cstddef>
#include <cstdint>

#include "mamori/kernel/base/span.hpp"
#include "mamori/kernel/base/status.hpp"
#include "mamori/safety/e2e/channel.hpp"
#include "mamori/safety/e2e/frame_cause.hpp"

namespace mamori::safety {

/// Sending end of one channel.
/// @tparam Profile E2eProfile01<> .. E2eProfile44<>.
/// @tparam Source  Profile::Channel, kept in the object; a port takes ConstantChannel.
///
/// Thread safety: none; one per sender. Time: O(length of the frame). Memory: the channel and a word; no
/// heap.
template <typename Profile, typename Source = typename Profile::Channel>
class E2eProtector final {
  public:
    using Channel = typename Profile::Channel;

    /// @param[in] channel a channel with a fault is kept, and refuses every frame.
    /// @param[in] counter of the first frame, 0 .. Profile::kCounterMax. A sender that restarts inside a
    /// counter period
    ///                    of a HARDENED receiver goes on where it was.
    explicit constexpr E2eProtector(const Source& channel,
                                    std::uint32_t counter = Profile::kFirstCounter) noexcept
        : channel_(channel), counter_(counter) {
        if (Profile::find_fault(channel) != ChannelFault::kNone || counter > Profile::kCounterMax) {
            is_ready_ = false;
        }
    }

    /// Writes the header over the bytes that the profile names; every other byte stays as it is.
    /// @param[in,out] frame payload around room for the header [bytes].
    /// @return kOk; kBadParameter (length outside the channel's); kPreconditionNotMet (channel or counter
    /// refused). The
    ///         counter moves with kOk only.
    constexpr Status protect(Span<std::byte> frame) noexcept {
        if (!is_ready_) {
            return Status::kPreconditionNotMet;
        }
        if (Profile::judge_length(channel_, frame.size()) != FrameCause::kGood) {
            return Status::kBadParameter;
        }
        Profile::write(channel_, counter_, frame);
        counter_ = counter_ == Profile::kCounterMax ? 0U : counter_ + 1U;
        return Status::kOk;
    }

    /// The frame that was protected last is replaced before it leaves: the next one gets its counter. Only
    /// after a protect() that gave kOk, once.
    constexpr void take_back() noexcept { counter_ = counter_ == 0U ? Profile::kCounterMax : counter_ - 1U; }

    /// Counter of the next frame.
    constexpr std::uint32_t get_counter() const noexcept { return counter_; }

  private:
    Source channel_;
    std::uint32_t counter_;
    bool is_ready_{true};
};

}  // namespace mamori::safety

#endif  // MAMORI_SAFETY_E2E_PROTECTOR_HPP
