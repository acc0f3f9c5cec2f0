// SPDX-License-Identifier: Apache-2.0
/// @file
/// Faults of time, put into a system that runs by the clock: work that takes too long, windows that are
/// released too late, at random places and of random size. Judges whether each was seen, in time and under
/// its name, and that nothing else was.
#ifndef MAMORI_TIME_FAULTS_TIME_FAULTS_HPP
#define MAMORI_TIME_FAULTS_TIME_FAULTS_HPP

#include <cstdint>
#include <string>
#include <vector>

#include "judge.hpp"
#include "mamori/kernel/time.hpp"

namespace mamori::time_faults {

/// Frames between two faults, at least: the longest fault and its aftermath.
inline constexpr std::uint64_t kDistance = 10U;

enum class Kind : std::uint8_t {
    kLoop,        ///< a component computes for too long
    kSleep,       ///< a component waits for too long
    kLateRelease  ///< the thread that opens the windows comes too late
};

struct Injection {
    std::uint64_t frame{0U};
    Kind kind{Kind::kLoop};
    std::size_t place{0U};  ///< component, or window of a late release
    Duration size{};        ///< 1.1 to 4 ticks
};

/// Frames and faults of a run. `frame_count` must hold kDistance frames for each fault.
struct Request {
    std::uint64_t frame_count{0U};
    std::size_t injection_count{0U};
    std::uint64_t seed{1U};
};

/// The same request gives the same faults, in the order of their frames.
std::vector<Injection> make_injections(const Request& request);

/// Runs it: `frame_count` ticks. To be called once per process.
Verdict run(const Request& request);

/// One JSON document.
std::string to_json(const Request& request, const Verdict& verdict);

}  // namespace mamori::time_faults

#endif  // MAMORI_TIME_FAULTS_TIME_FAULTS_HPP
