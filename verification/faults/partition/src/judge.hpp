// SPDX-License-Identifier: Apache-2.0
/// @file
/// Holds what a safety system did beside a failing partition against what it was to do: windows in the order
/// of virtual time, and the declared reaction, in time, to each fault and to nothing else. Pure functions of
/// what was written down.
#ifndef MAMORI_PARTITION_FAULTS_JUDGE_HPP
#define MAMORI_PARTITION_FAULTS_JUDGE_HPP

#include <cstdint>
#include <vector>

#include "mamori/kernel/base/time.hpp"
#include "mamori/verification/run_verdict.hpp"
#include "mamori/verification/stall_watch.hpp"

namespace mamori::partition_faults {

using verification::Stall;
using namespace literals;  // NOLINT: units of the constants below

/// What is done to the partition, or by it.
enum class Kind : std::uint8_t { kKill, kStop, kFlood, kCorrupt };
inline constexpr std::size_t kKindCount{4U};
const char* get_name(Kind kind) noexcept;

/// What the safety system calls it; in the order of its reaction table.
enum class PartitionFault : std::uint16_t { kSilent, kFlooding, kCorrupt, kCount };

inline constexpr Duration kFrame = 1_ms;
/// Frames in a row without a good answer that are the end of the partition.
inline constexpr std::uint32_t kSilentFrames{50U};
/// More frames than this between two looks are a flood. The safety side may stand still for so many itself.
inline constexpr std::uint64_t kSkippedMax{64U};
/// From the confirmed fault to its reaction.
inline constexpr Duration kReactionTime = 2_ms;
/// From the last time that all was well to the reaction: the silence, two frames until it is seen at the
/// drive, and the time of the reaction.
inline constexpr Duration kBound{(static_cast<std::int64_t>(kSilentFrames) + 2) * kFrame.ns +
                                 kReactionTime.ns};

/// Time that the host must have taken from a window to be the cause why it moved: half of its budget. At once
/// it sets the window aside, in pieces it makes the run inconclusive.
inline constexpr Duration kLossMin = 115_us;
/// The same from the frame before on: a whole budget. A window sees two to four looks, too few to tell by
/// them alone how slow the machine is just then; what falls between them is lost as well. Measured: less
/// than a tenth of the windows lie behind such a frame, and 98 of 100 that moved.
inline constexpr Duration kSlowLossMin = 230_us;

/// Another program must have had the processor for so long of a window to be the reason why it moved: as much
/// as a look of the watch is late by.
inline constexpr Duration kForeignMin = 25_us;

/// A window that opened.
struct Opening {
    std::size_t window{0U};
    Instant release{};
};
constexpr bool operator==(const Opening& a, const Opening& b) noexcept {
    return a.window == b.window && a.release == b.release;
}

/// One opening by the clock.
struct TimedOpening {
    Opening opening{};
    Instant woke{};
    Instant end{};
    bool is_missed{false};   ///< opened after its close: nothing ran
    bool is_overrun{false};  ///< was cut off
};

/// What the receiver found in one frame.
struct Look {
    Instant at{};                ///< when its window opened, by the table
    bool is_answer{false};       ///< a frame that is an answer
    bool is_check_right{false};  ///< and has the right check
    bool is_refused{false};      ///< a frame that is none, whole
    std::uint64_t skipped{0U};
};

/// A reaction began at the drive.
struct ReactionBegin {
    Instant at{};
    PartitionFault fault{PartitionFault::kCount};
    bool is_declared{false};  ///< it is the one of the table for that fault
};

/// A fault of the partition.
struct Deed {
    Kind kind{Kind::kKill};
    Instant begin{};
    Instant done{};       ///< from here on nothing is well
    Instant over{};       ///< the partition has ended
    bool is_done{false};  ///< false: the partition did not come to it
};

/// Everything that was written down of a run, each list in the order of its instants.
struct Course {
    std::vector<Opening> expected{};  ///< of virtual time, from the same frame on
    std::vector<Opening> ran{};       ///< by the components themselves
    std::vector<TimedOpening> openings{};
    std::vector<Look> looks{};
    std::vector<ReactionBegin> reactions{};
    std::vector<Deed> deeds{};
    std::vector<Stall> stalls{};
    std::vector<Stall> late_looks{};  ///< of whoever tells of stalls
    bool knows_foreign{false};
    std::vector<Stall> foreign{};  ///< while another program had the processor; with knows_foreign only
};

/// What became of one fault.
enum class Outcome : std::uint8_t {
    kInTime,
    kTardyByHost,  ///< too late, and the machine stood still in between
    kTardy,
    kUnseen,
    kMisnamed,  ///< a fault that it cannot have been, or not its declared reaction
    kNotDone,   ///< the partition did not come to it
};
inline constexpr std::size_t kOutcomeCount{6U};
const char* get_name(Outcome outcome) noexcept;

/// Lateness of the openings: from the planned instant to the first reading of the clock after it [ns].
struct LatenessFigures {
    std::uint64_t openings{0U};
    std::int64_t p50_ns{0};
    std::int64_t p99_ns{0};
    std::int64_t p9999_ns{0};
    std::int64_t max_ns{0};
    std::uint64_t moved{0U};   ///< of the openings, as Verdict::moved
    std::uint64_t stalls{0U};  ///< of the machine, in that time
    Duration time{};           ///< how long that was
};

struct Verdict {
    std::uint64_t requested{0U};
    std::vector<Outcome> outcomes{};                       ///< one per deed
    std::vector<std::vector<std::int64_t>> reaction_ns{};  ///< per kind, from Deed::done; sorted
    std::uint64_t frames{0U};
    std::uint64_t disordered{0U};       ///< windows that ran out of the order of virtual time
    std::vector<TimedOpening> moved{};  ///< windows missed or cut off otherwise
    std::uint64_t moved_by_host{0U};  ///< likewise; the host took kLossMin at once, or the window before did
    std::uint64_t moved_suspected{0U};        ///< likewise; a shorter stall, or losses in pieces
    std::vector<TimedOpening> moved_alone{};  ///< likewise; nobody else had the processor for kForeignMin
    std::vector<ReactionBegin> invented{};    ///< reactions that what arrived does not explain
    std::uint64_t by_machine{
        0U};                   ///< reactions because the machine gave the partition, or the guard, no time
    LatenessFigures quiet{};   ///< while the partition was well
    LatenessFigures faulty{};  ///< from a fault to the end of its partition
    bool has_priority{false};
    bool knows_foreign{false};
    verification::HostFigures host{};
    bool has_run{false};      ///< else the campaign could not go on: `trouble` tells why
    bool is_too_slow{false};  ///< the host is the reason
    const char* trouble{""};

    std::uint64_t count(Outcome outcome) const noexcept;
    /// A few faults may not come about while the machine stands still; more that do not are no test.
    bool is_well() const noexcept;
    /// For `assess_run()`.
    verification::RunEvidence get_evidence() const noexcept;
};

/// @return everything but `requested`, `has_priority`, `has_run` and `trouble`.
Verdict judge(const Course& course);

}  // namespace mamori::partition_faults

#endif  // MAMORI_PARTITION_FAULTS_JUDGE_HPP
