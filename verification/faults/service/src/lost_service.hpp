// SPDX-License-Identifier: Apache-2.0
/// @file
/// Takes the service away from the watchdog of a system that runs by the clock, in each way and at random
/// instants, and judges whether the outputs were closed in time.
#ifndef MAMORI_LOST_SERVICE_LOST_SERVICE_HPP
#define MAMORI_LOST_SERVICE_LOST_SERVICE_HPP

#include <cstdint>
#include <string>

#include "loss_judge.hpp"
#include "mamori/verification/run_verdict.hpp"
#include "mamori/verification/seeded_defect.hpp"

namespace mamori::lost_service {

/// Longest time without a service in these runs: that of the example arm.
inline constexpr Duration kServiceTimeout{5'000'000};

/// Trials go through the ways in turn, kNone among them, each with a new watchdog; the seed gives the
/// instants.
struct LossRequest {
    std::uint64_t trial_count{0U};
    std::uint64_t seed{1U};
    verification::Defect defect{verification::Defect::kNone};
};

/// What came of it.
struct LossRun {
    LossVerdict verdict{};
    std::uint64_t frames{0U};  ///< in all, most of them served
    verification::HostFigures host{};
    bool has_priority{false};
    std::vector<LossTrial> trials{};
    std::vector<Stall> stalls{};

    /// For `assess_run()`.
    verification::RunEvidence get_evidence() const noexcept;
};

/// Some 40 frames of 1 ms for each trial. To be called from the same thread each time.
LossRun run_losses(const LossRequest& request);

/// One JSON document.
std::string to_json(const LossRequest& request, const LossRun& run);

/// @return false: the file cannot be written.
bool write_course(const LossRequest& request, const LossRun& run, const char* path);

}  // namespace mamori::lost_service

#endif  // MAMORI_LOST_SERVICE_LOST_SERVICE_HPP
