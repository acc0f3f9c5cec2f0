// SPDX-License-Identifier: Apache-2.0
/// @file
/// Runs a safety system in real time next to a process that is killed, stopped, floods and corrupts at random
/// instants, and restarts it after each.
#ifndef MAMORI_PARTITION_FAULTS_CAMPAIGN_HPP
#define MAMORI_PARTITION_FAULTS_CAMPAIGN_HPP

#include <cstdint>
#include <vector>

#include "course.hpp"
#include "mamori/verification/seeded_defect.hpp"

namespace mamori::partition_faults {

/// Most faults of one run: their records fit into the memory that is taken before.
inline constexpr std::uint64_t kFaultsMax{5000U};

/// One fault of the plan.
struct Fault {
    Kind kind{Kind::kKill};
    Duration wait{};  ///< from a partition that is well to the fault; 20 to 120 ms
    Duration hold{};  ///< from the reaction to the end of the partition; 0 to 30 ms
};

/// Which faults, and how many: 1 .. kFaultsMax.
struct CampaignRequest {
    std::uint64_t fault_count{0U};
    std::uint64_t seed{1U};
    const char* worker{nullptr};  ///< path of the program of the partition
    verification::Defect defect{verification::Defect::kNone};
};

/// The same request gives the same faults. Each kind comes once in four faults.
std::vector<Fault> make_plan(const CampaignRequest& request);

/// Runs it: some 0.2 s per fault. Call once per process.
Course run(const CampaignRequest& request);

/// @return false: the file cannot be written.
bool write_course(const CampaignRequest& request, const Course& course, const char* path);

}  // namespace mamori::partition_faults

#endif  // MAMORI_PARTITION_FAULTS_CAMPAIGN_HPP
