// SPDX-License-Identifier: Apache-2.0
/// @file
/// A system of the size that a robot has: 100 components on 2 cores at 1000, 500, 200 and 100 Hz, with values
/// that cross between the cores, queues, and readers that are too slow for theirs. Run in virtual time.
///
/// @satisfies SWR-INS-006      Design: docs/design/kernel.md#scale
#ifndef MAMORI_VERIFICATION_INTEGRATION_SCALE_SYSTEM_HPP
#define MAMORI_VERIFICATION_INTEGRATION_SCALE_SYSTEM_HPP

#include <cstdint>

namespace mamori::verification::integration {

/// Cycles of the fastest rate in one frame: a run is a whole number of frames.
inline constexpr std::uint64_t kCyclesPerFrame = 10U;

/// What a run was.
struct ScaleResult {
    std::uint64_t trace_hash;     ///< over the trace hashes of both cores
    std::uint64_t overrun_count;  ///< 0 in a sound run
    std::uint64_t lost_count;     ///< values that the queues of slow readers refused or gave up
    std::uint64_t row_count;      ///< rows that were read of the introspection
};

/// Runs the system once; it is one of the program's static objects, so a second call goes on at its end (own
/// bug). @param[in] frames of 10 ms each.
/// @param[in] is_watched reads the whole introspection 1000 times per second of virtual time.
ScaleResult run_scale(std::uint64_t frames, bool is_watched);

}  // namespace mamori::verification::integration

#endif  // MAMORI_VERIFICATION_INTEGRATION_SCALE_SYSTEM_HPP
