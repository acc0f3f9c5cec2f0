// SPDX-License-Identifier: Apache-2.0
/// @file
/// Measures cases in rounds. A round visits each case once. Within a case, the subjects alternate batch by
/// batch. A host disturbance that lasts longer than a few batches therefore affects all subjects equally.
///
/// @satisfies SWR-BEN-001      Design: docs/design/bench.md#method
#ifndef MAMORI_VERIFICATION_BENCH_ROUNDS_HPP
#define MAMORI_VERIFICATION_BENCH_ROUNDS_HPP

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "subject.hpp"

namespace mamori::verification::bench {

/// Extent of a measurement.
struct Effort {
    std::uint32_t rounds{9U};
    std::uint32_t batches{21U};  ///< of each subject in a round
    /// Minimum time of one batch. It is much shorter than the time slice of a scheduler, so that most batches
    /// are not interrupted.
    std::uint64_t batch_ns{400'000U};
};

/// Times of one subject: for each round, the median of its batches, in the unit of the case.
struct Series {
    std::string name;
    std::uint64_t batch_count;  ///< operations in a batch
    std::vector<double> rounds;
};

/// A measured case, and the subjects that could not be created, with the reason.
struct Measured {
    std::string metric;
    std::size_t size;
    std::string unit;
    std::vector<Series> series;
    std::vector<AbsentPeer> absent;
};

/// Measures `cases`. @param[in] tell receives a line of progress.
/// @throw std::runtime_error if the sum of a subject shows that it did not complete its work.
std::vector<Measured> measure(const std::vector<Case>& cases, const Effort& effort,
                              const std::function<void(const std::string&)>& tell);

}  // namespace mamori::verification::bench

#endif  // MAMORI_VERIFICATION_BENCH_ROUNDS_HPP
