// SPDX-License-Identifier: Apache-2.0
/// @file
/// Injects faults of time into a system in real time, at random instants and of random size, and records
/// injections and reports. The faults: work that takes too long; windows that start too late; a guard, a
/// runner or a timer that hangs; a fast or slow clock; a component that waits for a thread without priority.
///
/// @satisfies SWR-PRT-036
/// Design: docs/design/posix_rt.md#faults-of-time
#ifndef MAMORI_TIME_FAULTS_TIME_FAULTS_HPP
#define MAMORI_TIME_FAULTS_TIME_FAULTS_HPP

#include <cstdint>
#include <vector>

#include "course.hpp"
#include "mamori/kernel/base/time.hpp"
#include "mamori/ports/posix_rt/grid_watch.hpp"
#include "mamori/verification/seeded_defect.hpp"

namespace mamori::time_faults {

using verification::Defect;
using verification::kDefectEvery;

/// Minimum number of frames between two faults: the longest fault, its aftermath, and the reset of the
/// monitor.
inline constexpr std::uint64_t kDistance = 80U;

/// Limits of the monitor: it finds overdue work within a tick, and a clock deviation of 0.5 % or more.
inline constexpr ports::posix_rt::GridLimits kWatchLimits{
    Duration{300'000}, Duration{200'000}, {Duration{10'000'000}, 5000}};

enum class Kind : std::uint8_t {
    kLoop,         ///< a component computes for too long
    kSleep,        ///< a component waits for too long
    kLockedOut,    ///< a component waits for a mutex of a thread that does not run
    kLateRelease,  ///< the thread that starts the windows is late
    kStuckGuard,   ///< a component computes for too long, and the deadline of the guard does not come
    kStuckRunner,  ///< the thread that starts the windows hangs after a window
    kStuckTick,    ///< the sleep until a window does not end
    kFastClock,
    kSlowClock
};
inline constexpr std::uint64_t kKindCount = 9U;

struct Injection {
    std::uint64_t frame{0U};
    Kind kind{Kind::kLoop};
    std::size_t place{0U};  ///< component; or window of a release, runner or tick
    Duration size{};        ///< 1.1 to 4 ticks; of a clock 25 ticks
    std::int64_t ppm{0};    ///< of a clock: 1 to 10 %, with sign
};

/// Frames and faults of a run. `frame_count` must contain kDistance frames for each fault.
struct Request {
    std::uint64_t frame_count{0U};
    std::size_t injection_count{0U};
    std::uint64_t seed{1U};
    bool with_storm{false};  ///< another process permanently causes page faults
    Defect defect{Defect::kNone};
};

/// The same request gives the same faults, in the order of their frames.
std::vector<Injection> make_injections(const Request& request);

/// Executes the plan: `frame_count` ticks. Call once per process, while it has one thread.
Course run(const Request& request);

/// @return false: the file cannot be written.
bool write_course(const Request& request, const Course& course, const char* path);

}  // namespace mamori::time_faults

#endif  // MAMORI_TIME_FAULTS_TIME_FAULTS_HPP
