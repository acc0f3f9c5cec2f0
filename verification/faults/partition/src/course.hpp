// SPDX-License-Identifier: Apache-2.0
/// @file
/// Everything that is recorded of a safety system next to a failing partition: windows, messages, reactions,
/// injections and host causes. `verification/faults/evaluation` decides.
#ifndef MAMORI_PARTITION_FAULTS_COURSE_HPP
#define MAMORI_PARTITION_FAULTS_COURSE_HPP

#include <cstdint>
#include <vector>

#include "mamori/kernel/base/time.hpp"
#include "mamori/verification/stall_watch.hpp"

namespace mamori::partition_faults {

using verification::Stall;
using namespace literals;  // NOLINT: units of the constants below

/// What is done to the partition, or by it.
enum class Kind : std::uint8_t { kKill, kStop, kFlood, kCorrupt };
inline constexpr std::size_t kKindCount{4U};

/// What the safety system calls it; in the order of its reaction table.
enum class PartitionFault : std::uint16_t { kSilent, kFlooding, kCorrupt, kCount };

inline constexpr Duration kFrame = 1_ms;
/// Major frames in a row without a valid reply that are the end of the partition.
inline constexpr std::uint32_t kSilentFrames{50U};
/// More messages than this between two polls are a flood. The safety side may stall for so many itself.
inline constexpr std::uint64_t kSkippedMax{64U};
/// From the confirmed fault to its reaction.
inline constexpr Duration kReactionTime = 2_ms;

/// A window instance.
struct Opening {
    std::size_t window{0U};
    Instant release{};
};

/// One window instance in real time.
struct TimedOpening {
    Opening opening{};
    Instant woke{};
    Instant end{};
    bool is_missed{false};   ///< started after its end: nothing ran
    bool is_overrun{false};  ///< was aborted
};

/// What the receiver found in one major frame.
struct Reception {
    Instant at{};                ///< planned start of its window
    bool is_answer{false};       ///< a message that is an answer
    bool is_check_right{false};  ///< and has the right check
    bool is_malformed{false};    ///< a message that is not intact
    std::uint64_t skipped{0U};
};

/// A reaction began at the drive.
struct ReactionBegin {
    Instant at{};
    PartitionFault fault{PartitionFault::kCount};
    bool is_declared{false};  ///< it is the one of the table for that fault
};

/// A fault of the partition.
struct Injected {
    Kind kind{Kind::kKill};
    Instant begin{};
    Instant done{};       ///< from here on nothing is well
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
    std::vector<Stall> foreign{};  ///< while another program had the processor; with knows_foreign only
    verification::HostFigures host{};
    bool has_priority{false};
    bool is_too_slow{false};  ///< the host is the reason of `trouble`
    const char* trouble{""};  ///< why the campaign could not continue; empty: it is complete
};

}  // namespace mamori::partition_faults

#endif  // MAMORI_PARTITION_FAULTS_COURSE_HPP
