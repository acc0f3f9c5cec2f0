// SPDX-License-Identifier: Apache-2.0
/// @file
/// All records of a safety system in parallel to a failing partition: windows, messages, reactions,
/// injections and host causes. `verification/faults/evaluation` evaluates them.
#ifndef MAMORI_PARTITION_FAULTS_COURSE_HPP
#define MAMORI_PARTITION_FAULTS_COURSE_HPP

#include <cstdint>
#include <vector>

#include "mamori/kernel/base/time.hpp"
#include "mamori/verification/stall_watch.hpp"

namespace mamori::partition_faults {

using verification::Stall;
using namespace literals;  // NOLINT: units of the constants below

/// What is done to the partition, or what the partition does.
enum class Kind : std::uint8_t { kKill, kStop, kFlood, kCorrupt };
inline constexpr std::size_t kKindCount{4U};

/// Name of the fault in the safety system; in the order of its reaction table.
enum class PartitionFault : std::uint16_t { kSilent, kFlooding, kCorrupt, kInternal, kCount };

inline constexpr Duration kFrame = 1_ms;
/// After this number of consecutive major frames without a valid reply, the partition counts as ended.
inline constexpr std::uint32_t kSilentFrames{50U};
/// More messages than this between two polls are a flood. The safety side itself may stall for as many
/// messages.
inline constexpr std::uint64_t kSkippedMax{64U};
/// From the confirmed fault to its reaction.
inline constexpr Duration kReactionTime = 2_ms;

/// A planned or executed window instance.
struct Opening {
    std::size_t window{0U};
    Instant release{};
};

/// One window instance in real time.
struct TimedOpening {
    Opening opening{};
    Instant woke{};
    Instant end{};
    bool is_missed{false};   ///< started after its end: no component ran
    bool is_overrun{false};  ///< was aborted
};

/// What the receiver found in one major frame.
struct Reception {
    Instant at{};                ///< planned start of its window
    bool is_answer{false};       ///< the message is a reply
    bool is_check_right{false};  ///< the check of the reply is correct
    bool is_malformed{false};    ///< the message is not intact
    std::uint64_t skipped{0U};
};

/// A reaction began at the drive.
struct ReactionBegin {
    Instant at{};
    PartitionFault fault{PartitionFault::kCount};
    bool is_declared{false};  ///< the table declares it for that fault
};

/// A fault of the partition.
struct Injected {
    Kind kind{Kind::kKill};
    Instant begin{};
    Instant done{};       ///< from here on no valid reply is expected
    Instant over{};       ///< the partition has ended
    bool is_done{false};  ///< false: the partition did not do it
};

/// Each list in the order of its instants.
struct Course {
    std::vector<Opening> expected{};  ///< of virtual time, from the same major frame on
    std::vector<Opening> ran{};       ///< by the components themselves
    std::vector<TimedOpening> openings{};
    std::vector<Reception> receptions{};
    std::vector<ReactionBegin> reactions{};
    std::vector<Injected> injections{};
    std::vector<Stall> stalls{};
    std::vector<Stall> late_polls{};
    bool knows_foreign{false};
    std::vector<Stall> foreign{};  ///< another program used the processor; only with knows_foreign
    verification::HostFigures host{};
    bool has_priority{false};
    bool is_too_slow{false};  ///< the host is the cause of `trouble`
    const char* trouble{""};  ///< why the campaign could not continue; empty if it is complete
};

}  // namespace mamori::partition_faults

#endif  // MAMORI_PARTITION_FAULTS_COURSE_HPP
