// SPDX-License-Identifier: Apache-2.0
/// @file
/// Runs a safety system in real time in parallel to a process that is killed, stopped, floods and corrupts at
/// random instants. The process restarts after each fault.
#ifndef MAMORI_PARTITION_FAULTS_CAMPAIGN_HPP
#define MAMORI_PARTITION_FAULTS_CAMPAIGN_HPP

#include <cstdint>
#include <vector>

#include "course.hpp"
#include "mamori/verification/seeded_defect.hpp"

namespace mamori::partition_faults {

/// Maximum number of faults of one run: their records fit into the memory that is allocated in advance.
inline constexpr std::uint64_t kFaultsMax{5000U};

/// One fault of the plan.
struct Fault {
    Kind kind{Kind::kKill};
    Duration wait{};  ///< from a valid state of the partition to the fault; 20 to 120 ms
    Duration hold{};  ///< from the reaction to the end of the partition; 0 to 30 ms
};

/// Number of faults: 1 .. kFaultsMax; and which faults.
struct CampaignRequest {
    std::uint64_t fault_count{0U};
    std::uint64_t seed{1U};
    const char* worker{nullptr};  ///< path of the program of the partition
    verification::Defect defect{verification::Defect::kNone};
};

/// The same request gives the same faults. Each kind occurs once in four faults.
std::vector<Fault> make_plan(const CampaignRequest& request);

/// Executes the plan; takes about 0.2 s per fault. Call once per process.
Course run(const CampaignRequest& request);

/// @return false: the file cannot be written.
bool write_course(const CampaignRequest& request, const Course& course, const char* path);

}  // namespace mamori::partition_faults

#endif  // MAMORI_PARTITION_FAULTS_CAMPAIGN_HPP
