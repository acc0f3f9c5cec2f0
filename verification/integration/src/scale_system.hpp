// SPDX-License-Identifier: Apache-2.0
/// @file
/// A system of realistic size: 100 components on 2 cores at 1000, 500, 200 and 100 Hz, with inter-core
/// values, queues, and readers that are slower than their writers. It runs in virtual time.
///
/// @satisfies SWR-INS-006      Design: docs/design/kernel.md#scale
#ifndef MAMORI_VERIFICATION_INTEGRATION_SCALE_SYSTEM_HPP
#define MAMORI_VERIFICATION_INTEGRATION_SCALE_SYSTEM_HPP

#include <cstdint>

namespace mamori::verification::integration {

/// Cycles of the fastest rate in one major frame; a run consists of complete major frames.
inline constexpr std::uint64_t kCyclesPerFrame = 10U;

/// Results of a run.
struct ScaleResult {
    std::uint64_t trace_hash;     ///< of the trace hashes of both cores
    std::uint64_t overrun_count;  ///< 0 in a valid run
    std::uint64_t lost_count;     ///< values that the queues of slow readers rejected or dropped
    std::uint64_t row_count;      ///< introspection rows that were read
};

/// Runs the system once. The system is a static object of the program, so a second call would continue at its
/// end (contract violation). @param[in] frames of 10 ms each.
/// @param[in] is_watched reads the complete introspection 1000 times per second of virtual time.
ScaleResult run_scale(std::uint64_t frames, bool is_watched);

}  // namespace mamori::verification::integration

#endif  // MAMORI_VERIFICATION_INTEGRATION_SCALE_SYSTEM_HPP
