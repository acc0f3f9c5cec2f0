// SPDX-License-Identifier: Apache-2.0
/// @file
/// The order of frames, judged as AUTOSAR does (CONFORMANT): profiles 1 and 2 have rules of their own, all
/// others share one. Both move their baseline on frames that they refuse; hardened_sequence.hpp does not.
///
/// @satisfies SWR-E2E-006      Design: docs/design/e2e.md#order-of-messages
/// Source:   AUTOSAR PRS E2E Protocol, check functions of the profiles
#ifndef MAMORI_SAFETY_E2E_SEQUENCE_HPP
#define MAMORI_SAFETY_E2E_SEQUENCE_HPP

#include <cstdint>

#include "mamori/safety/e2e/channel.hpp"
#include "mamori/safety/e2e/check_status.hpp"

namespace mamori::safety {

/// Steps forward from `last` to `received`, where 0 follows `counter_max`. @param[in] last, received 0 ..
/// counter_max.
constexpr std::uint32_t calc_counter_delta(std::uint32_t last, std::uint32_t received,
                                           std::uint32_t counter_max) noexcept {
    // Unsigned arithmetic wraps by definition: right for a counter of 32 bits too.
    return received >= last ? received - last : received + (counter_max - last) + 1U;
}

/// Limits of PlainSequence.
struct PlainLimits {
    std::uint32_t max_delta{
        1U};  ///< greatest step forward that is accepted, 1 .. greatest counter; 1: no loss
};

/// Rule of profiles 4, 5, 6, 7, 8, 11, 22 and 44: each whole frame is compared with the whole frame before
/// it.
///
/// Thread safety: none. Time: O(1). Memory: four words.
class PlainSequence final {
  public:
    using Limits = PlainLimits;

    static constexpr ChannelFault find_fault(const Limits& limits, std::uint32_t counter_max) noexcept {
        const bool is_sound = limits.max_delta >= 1U && limits.max_delta <= counter_max;
        return is_sound ? ChannelFault::kNone : ChannelFault::kLimits;
    }
    constexpr PlainSequence(const Limits& limits, std::uint32_t counter_max) noexcept
        : limits_(limits), counter_max_(counter_max), last_(counter_max) {}

    /// Judges a whole frame. @return kOk, kOkSomeLost, kRepeated or kWrongSequence.
    constexpr CheckStatus judge(std::uint32_t counter) noexcept {
        const std::uint32_t delta = calc_counter_delta(last_, counter, counter_max_);
        last_ = counter;
        lost_count_ = 0U;
        if (delta > limits_.max_delta) {
            return CheckStatus::kWrongSequence;
        }
        if (delta == 0U) {
            return CheckStatus::kRepeated;
        }
        lost_count_ = delta - 1U;
        return delta == 1U ? CheckStatus::kOk : CheckStatus::kOkSomeLost;
    }
    constexpr void note_silence() noexcept {}
    constexpr void note_fault() noexcept {}
    /// Begins anew, as after construction.
    constexpr void restart() noexcept {
        last_ = counter_max_;
        lost_count_ = 0U;
    }
    /// Frames that were lost before the last accepted one.
    constexpr std::uint32_t get_lost_count() const noexcept { return lost_count_; }

  private:
    Limits limits_;
    std::uint32_t counter_max_;
    std::uint32_t last_;
    std::uint32_t lost_count_{0U};
};

/// Limits of SynchronisingSequence. Range of each: 0 .. greatest counter.
struct SynchronisingLimits {
    std::uint8_t max_delta_init{1U};  ///< greatest step right after a frame; one more per silent check
    std::uint8_t max_no_new_or_repeated{
        1U};                     ///< so many silent or repeated checks in a row need no new proof
    std::uint8_t sync_init{1U};  ///< frames that prove the order anew
};

/// Rule of profiles 1 and 2: tolerance grows with silence, and the order is proven anew after a break.
///
/// Thread safety: none. Time: O(1). Memory: some words.
class SynchronisingSequence final {
  public:
    using Limits = SynchronisingLimits;

    static constexpr ChannelFault find_fault(const Limits& limits, std::uint32_t counter_max) noexcept {
        const bool is_sound = limits.max_delta_init <= counter_max &&
                              limits.max_no_new_or_repeated <= counter_max && limits.sync_init <= counter_max;
        return is_sound ? ChannelFault::kNone : ChannelFault::kLimits;
    }
    constexpr SynchronisingSequence(const Limits& limits, std::uint32_t counter_max) noexcept
        : limits_(limits), counter_max_(counter_max), max_delta_(limits.max_delta_init) {}

    /// Judges a whole frame. @return any status but kNoNewData and kError.
    CheckStatus judge(std::uint32_t counter) noexcept;
    /// A check without a frame.
    void note_silence() noexcept;
    /// A check of a frame that is not whole.
    void note_fault() noexcept { widen(); }
    /// Begins anew, as after construction.
    void restart() noexcept;
    /// Frames that were lost before the last one that was in order.
    constexpr std::uint32_t get_lost_count() const noexcept { return lost_count_; }

  private:
    /// Each check may have missed one more frame.
    void widen() noexcept;
    /// One more check without news; held at the greatest counter, beyond which it decides nothing.
    void count_without_news() noexcept;
    CheckStatus accept(std::uint32_t counter, std::uint32_t delta) noexcept;
    CheckStatus refuse(std::uint32_t counter) noexcept;

    Limits limits_;
    std::uint32_t counter_max_;
    std::uint32_t max_delta_;
    std::uint32_t last_{0U};
    std::uint32_t lost_count_{0U};
    std::uint32_t without_news_{0U};
    std::uint32_t sync_left_{0U};
    bool is_first_{true};
};

}  // namespace mamori::safety

#endif  // MAMORI_SAFETY_E2E_SEQUENCE_HPP
