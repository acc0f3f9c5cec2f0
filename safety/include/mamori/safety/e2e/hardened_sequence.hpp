// SPDX-License-Identifier: Apache-2.0
/// @file
/// The order of frames, HARDENED: the baseline moves on accepted frames only, so a frame of the past is
/// refused however many of them come. The price: after too many losses the order is found again by a rule, or
/// by a deliberate reset.
///
/// @satisfies SWR-E2E-007, SWR-E2E-008, SWR-E2E-028      Design: docs/design/e2e.md#hardened-order
#ifndef MAMORI_SAFETY_E2E_HARDENED_SEQUENCE_HPP
#define MAMORI_SAFETY_E2E_HARDENED_SEQUENCE_HPP

#include <cstdint>

#include "mamori/safety/e2e/channel.hpp"
#include "mamori/safety/e2e/check_status.hpp"

namespace mamori::safety {

/// What may end a break in the order.
enum class Resynchronisation : std::uint8_t {
    kByReset,  ///< restart() only: a larger step forward closes the channel, and nothing that comes over the
               ///< channel opens it again
    kByRun,    ///< restart(), or a run of frames in order: a recorded run of that length is taken for a new
               ///< sender
};

/// Limits of HardenedSequence.
struct HardenedLimits {
    /// Greatest step forward that is accepted: one more than the messages that may be lost in a row. Without
    /// a default: 0 is refused. Range: 1 .. half the greatest counter.
    std::uint32_t max_delta{0U};
    std::uint8_t resync_frames{
        2U};  ///< frames in order, without another between, that make a baseline, 2 .. 255
    Resynchronisation resynchronisation{Resynchronisation::kByReset};
};

/// Order of frames that the past cannot move. For any profile.
///
/// Thread safety: none. Time: O(1). Memory: some words.
class HardenedSequence final {
  public:
    using Limits = HardenedLimits;

    static constexpr ChannelFault find_fault(const Limits& limits, std::uint32_t counter_max) noexcept {
        const bool is_sound =
            limits.max_delta >= 1U && limits.max_delta <= counter_max / 2U && limits.resync_frames >= 2U;
        return is_sound ? ChannelFault::kNone : ChannelFault::kLimits;
    }
    constexpr HardenedSequence(const Limits& limits, std::uint32_t counter_max) noexcept
        : limits_(limits), counter_max_(counter_max) {}

    /// Judges a whole frame. Frames of a run that makes a baseline are not for use, the last one included.
    /// @return kOk, kOkSomeLost, kRepeated or kWrongSequence.
    CheckStatus judge(std::uint32_t counter) noexcept;
    void note_silence() noexcept { count_absence(); }
    /// A frame that is not whole breaks a run.
    void note_fault() noexcept {
        run_ = 0U;
        count_absence();
    }
    /// Forgets the baseline: a run makes a new one. Only for a deliberate reset.
    void restart() noexcept;
    /// Frames that were lost before the last accepted one.
    constexpr std::uint32_t get_lost_count() const noexcept { return lost_count_; }
    /// How often a run made a baseline, the first one included.
    constexpr std::uint32_t get_resync_count() const noexcept { return resync_count_; }
    /// True while there is a baseline.
    constexpr bool is_synchronised() const noexcept { return is_synchronised_; }
    /// True from a step forward beyond the limit to restart() (kByReset): every frame is refused.
    constexpr bool is_closed() const noexcept { return is_closed_; }

  private:
    /// Checks without an accepted frame after which an older frame is no longer taken for a replay: the
    /// sender may have come past half the counter. It sends at most one frame per check.
    static constexpr std::uint32_t kAbsenceMax{255U};

    void count_absence() noexcept { absence_ += absence_ <= kAbsenceMax ? 1U : 0U; }
    CheckStatus judge_against_baseline(std::uint32_t counter) noexcept;
    bool is_order_lost(std::uint32_t counter) const noexcept;
    void extend_run(std::uint32_t counter) noexcept;

    Limits limits_;
    std::uint32_t counter_max_;
    std::uint32_t last_{0U};
    std::uint32_t run_end_{0U};  ///< counter of the newest frame of the run
    std::uint32_t run_{0U};      ///< frames of the run
    std::uint32_t lost_count_{0U};
    std::uint32_t resync_count_{0U};
    std::uint32_t absence_{0U};  ///< checks since the last accepted frame, 0 .. kAbsenceMax + 1
    bool is_synchronised_{false};
    bool is_closed_{false};
};

}  // namespace mamori::safety

#endif  // MAMORI_SAFETY_E2E_HARDENED_SEQUENCE_HPP
