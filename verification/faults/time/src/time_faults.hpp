// SPDX-License-Identifier: Apache-2.0
/// @file
/// Faults of time, injected into a system that runs in real time: work that takes too long, windows that
/// start too late, a guard, a runner and a timer that hang, a clock that is fast or slow, a component that
/// waits for a thread without priority; at random instants and of random size. Records what was injected and
/// reported.
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

/// Frames between two faults, at least: the longest fault, its aftermath, and the reset of the watch.
inline constexpr std::uint64_t kDistance = 80U;

/// Limits of the watch: it finds what is overdue within a tick, and a clock that is off by 0.5 % or more.
inline constexpr ports::posix_rt::GridLimits kWatchLimits{
    Duration{300'000}, Duration{200'000}, {Duration{10'000'000}, 5000}};

enum class Kind : std::uint8_t {
    kLoop,         ///< a component computes for too long
    kSleep,        ///< a component waits for too long
    kLockedOut,    ///< a component waits for a mutex of a thread that does not run
    kLateRelease,  ///< the thread that starts the windows is too late
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
    std::size_t place{0U};  ///< component, or window of a release, runner or tick
    Duration size{};        ///< 1.1 to 4 ticks; of a clock 25 ticks
    std::int64_t ppm{0};    ///< of a clock: 1 to 10 % in its direction
};

/// Frames and faults of a run. `frame_count` must hold kDistance frames for each fault.
struct Request {
    std::uint64_t frame_count{0U};
    std::size_t injection_count{0U};
    std::uint64_t seed{1U};
    bool with_storm{false};  ///< another process faults pages all the time
    Defect defect{Defect::kNone};
};

/// The same request gives the same faults, in the order of their frames.
std::vector<Injection> make_injections(const Request& request);

/// Runs it: `frame_count` ticks. Call once per process, while it has one thread.
Course run(const Request& request);

/// @return false: the file cannot be written.
bool write_course(const Request& request, const Course& course, const char* path);

}  // namespace mamori::time_faults

#endif  // MAMORI_TIME_FAULTS_TIME_FAULTS_HPP
