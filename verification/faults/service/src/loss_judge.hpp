// SPDX-License-Identifier: Apache-2.0
/// @file
/// Holds what a watchdog did against what was done to its service: outputs closed in time after each loss,
/// and left alone as long as it was served. Pure functions of what was written down.
#ifndef MAMORI_LOST_SERVICE_LOSS_JUDGE_HPP
#define MAMORI_LOST_SERVICE_LOSS_JUDGE_HPP

#include <cstdint>
#include <vector>

#include "mamori/kernel/base/time.hpp"
#include "mamori/ports/posix_rt/software_watchdog.hpp"
#include "mamori/verification/stall_watch.hpp"

namespace mamori::lost_service {

using verification::Stall;

/// Frame of the system, and what the reaction may take.
inline constexpr Duration kTick{1'000'000};

/// A stall at least as long may keep a service from its window; a shorter one makes it suspected only.
inline constexpr Duration kLongStall{500'000};

/// How the watchdog loses its service.
enum class Loss : std::uint8_t {
    kNone,          ///< not at all
    kHang,          ///< the supervisor computes for ever
    kWait,          ///< it waits for ever
    kUnhealthy,     ///< a component of the safety partition has expired, so the gate refuses
    kInconsistent,  ///< the safe-state machine contradicts itself, so the gate refuses
    kRunaway,       ///< a loop that runs wild serves again at once
    kNoWindow,      ///< the thread that opens the windows hangs, so no window opens
};
inline constexpr std::size_t kLossCount = 7U;

/// A watchdog from its first service on, and at most one loss.
struct LossTrial {
    Loss loss{Loss::kNone};
    bool is_injected{false};
    Instant injected_at{};
    Instant asked_at{};  ///< reading of the clock before the last service that was taken
    Instant taken_at{};  ///< and after it: the watchdog's time began in between
    bool is_closed{false};
    Instant closed_at{};  ///< of the outputs
    ports::posix_rt::WatchdogCause cause{ports::posix_rt::WatchdogCause::kNone};
    Instant ended_at{};  ///< reading of the clock before the watchdog was closed
};

/// All is well when nearly all losses took effect, each was answered in time, and nothing else was.
struct LossVerdict {
    std::uint64_t requested{0U};  ///< losses
    std::uint64_t injected{0U};   ///< that took effect; one may not when the machine stood still before it
    std::uint64_t answered{0U};   ///< outputs closed, in time or not
    std::uint64_t unanswered{0U};
    std::uint64_t late{0U};  ///< answered more than a tick after the time was over, while the machine ran
    std::uint64_t late_by_host{0U};  ///< likewise, by no more than the time of a stall
    std::uint64_t early{0U};         ///< answered before the time was over
    std::uint64_t invented{0U};      ///< closed without a loss, while the machine ran
    /// Closed or late, and stalls of the host explain it in part.
    std::uint64_t suspected{0U};
    /// Closed without a loss while the host stalled for kLongStall, or at an end before an answer was due:
    /// frames that the machine missed count as well.
    std::uint64_t by_host{0U};
    std::vector<std::int64_t> reaction_ns{};  ///< from the end of the watchdog's time to the closing
    std::vector<LossTrial> unexplained{};     ///< those that were invented, late or not answered

    bool is_well() const noexcept {
        return 20U * injected >= 19U * requested && answered == injected &&
               unanswered + late + early + invented + suspected == 0U;
    }
};

/// @param[in] timeout longest time without a service. @param[in] stalls in the order of their instants.
LossVerdict judge_losses(const std::vector<LossTrial>& trials, const std::vector<Stall>& stalls,
                         Duration timeout);

}  // namespace mamori::lost_service

#endif  // MAMORI_LOST_SERVICE_LOSS_JUDGE_HPP
