// SPDX-License-Identifier: Apache-2.0
/// @file
/// Takes the service away from the watchdog of a system in real time, in each way and at random instants, and
/// records when the outputs closed. `verification/faults/evaluation` evaluates the records.
#ifndef MAMORI_LOST_SERVICE_LOST_SERVICE_HPP
#define MAMORI_LOST_SERVICE_LOST_SERVICE_HPP

#include <cstdint>
#include <vector>

#include "mamori/kernel/base/time.hpp"
#include "mamori/ports/posix_rt/software_watchdog.hpp"
#include "mamori/verification/seeded_defect.hpp"
#include "mamori/verification/stall_watch.hpp"

namespace mamori::lost_service {

/// Major frame of the system.
inline constexpr Duration kTick{1'000'000};

/// Longest time without a service in these runs: the value of the example arm.
inline constexpr Duration kServiceTimeout{5'000'000};

/// How the watchdog loses its service.
enum class Loss : std::uint8_t {
    kNone,          ///< the service continues
    kHang,          ///< the supervisor computes until the outputs are closed
    kWait,          ///< the supervisor waits until the outputs are closed
    kUnhealthy,     ///< a component of the safety partition has expired, so the drive gate rejects
    kInconsistent,  ///< the safe-state machine is inconsistent, so the drive gate rejects
    kRunaway,       ///< an endless loop immediately services again
    kNoWindow,      ///< the thread that starts the windows hangs, so no window starts
};
inline constexpr std::size_t kLossCount = 7U;

/// A watchdog from its first service on, and at most one loss.
struct LossTrial {
    Loss loss{Loss::kNone};
    bool is_injected{false};
    Instant injected_at{};
    Instant asked_at{};  ///< reading of the clock before the last accepted service
    Instant taken_at{};  ///< reading after it: the watchdog time started in between
    bool is_closed{false};
    Instant closed_at{};  ///< when the outputs closed
    ports::posix_rt::WatchdogCause cause{ports::posix_rt::WatchdogCause::kNone};
    Instant ended_at{};  ///< reading of the clock before the watchdog was closed
};

/// Trials cycle through all losses including kNone, each with a new watchdog; the seed determines the
/// instants.
struct LossRequest {
    std::uint64_t trial_count{0U};
    std::uint64_t seed{1U};
    verification::Defect defect{verification::Defect::kNone};
};

/// The course of a run.
struct LossRun {
    std::vector<LossTrial> trials{};  ///< empty if the system did not start
    std::vector<verification::Stall> stalls{};
    std::uint64_t frames{0U};  ///< of all trials, most of them serviced
    verification::HostFigures host{};
    bool has_priority{false};
};

/// About 40 frames of 1 ms for each trial. Call once per process.
LossRun run_losses(const LossRequest& request);

/// @return false: the file cannot be written.
bool write_course(const LossRequest& request, const LossRun& run, const char* path);

}  // namespace mamori::lost_service

#endif  // MAMORI_LOST_SERVICE_LOST_SERVICE_HPP
