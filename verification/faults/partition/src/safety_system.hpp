// SPDX-License-Identifier: Apache-2.0
/// @file
/// The safety system in parallel to the partition: it sends requests, supervises the replies, and stops its
/// drive if replies are missing, too many or wrong. It records its actions.
#ifndef MAMORI_PARTITION_FAULTS_SAFETY_SYSTEM_HPP
#define MAMORI_PARTITION_FAULTS_SAFETY_SYSTEM_HPP

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <utility>
#include <vector>

#include "course.hpp"
#include "mamori/kernel/run/executive.hpp"
#include "mamori/kernel/system/system.hpp"
#include "mamori/ports/posix_rt/frame_clock.hpp"
#include "mamori/ports/posix_rt/guarded_host.hpp"
#include "mamori/ports/posix_rt/partition_link.hpp"
#include "mamori/safety/reaction/reaction_table.hpp"
#include "mamori/verification/seeded_defect.hpp"
#include "messages.hpp"

namespace mamori::partition_faults {

inline constexpr std::size_t kWindowCount{4U};
inline constexpr std::size_t kRequestCapacity = ports::posix_rt::PartitionSender<Request>::kCapacity;
inline constexpr std::size_t kAnswerCapacity = ports::posix_rt::PartitionReceiver<Answer>::kCapacity;

/// After missing replies or a flood, the drive stops along its path. After corruption, it stops immediately.
inline constexpr auto kFaults =
    parts(faults<PartitionFault::kSilent, PartitionFault::kFlooding, PartitionFault::kCorrupt,
                 PartitionFault::kInternal>(),
          react(PartitionFault::kSilent, safety::Reaction::kSs1, within(kReactionTime)),
          react(PartitionFault::kFlooding, safety::Reaction::kSs1, within(kReactionTime)),
          react(PartitionFault::kCorrupt, safety::Reaction::kSto, within(kReactionTime)),
          react(PartitionFault::kInternal, safety::Reaction::kSto, within(kReactionTime)));
inline constexpr auto kReactions = system(frame(kFrame), kFaults).reactions;

/// Records of the components, in memory that was allocated before the run; rows beyond the capacity are
/// dropped.
struct SystemLog {
    /// By index, because aborted work may return while another window runs.
    std::vector<Opening> ran{};
    std::atomic<std::size_t> ran_count{0U};
    std::vector<Reception> receptions{};
    std::vector<ReactionBegin> reactions{};
    /// The recorded window instances. Call once, after the run.
    std::vector<Opening> take_ran() {
        ran.resize(std::min(ran.size(), ran_count.load(std::memory_order_relaxed)));
        return std::move(ran);
    }

    const ports::posix_rt::FrameClock* clock{nullptr};         ///< nullptr: virtual time
    verification::Defect defect{verification::Defect::kNone};  ///< only in real time
};

/// Destination of the component records; set while no component runs.
extern SystemLog* system_log;

/// @name State and requests for other threads
/// @{
extern std::atomic<bool> is_stopped;           ///< a reaction is active at the drive
extern std::atomic<std::uint32_t> good_count;  ///< valid replies since the last pause
extern std::atomic<bool> is_reset_wanted;      ///< a deliberate reset; false after the attempt
/// @}

/// Open before the executive is initialised.
extern ports::posix_rt::FrameReader answer_reader;
extern ports::posix_rt::FrameWriter request_writer;

extern Executive& executive;
/// Runs the executive again from power-up on: a safety cycle accepts one initialisation only.
bool restart() noexcept;
extern std::array<ports::posix_rt::WindowThread, kWindowCount> window_threads;

}  // namespace mamori::partition_faults

#endif  // MAMORI_PARTITION_FAULTS_SAFETY_SYSTEM_HPP
