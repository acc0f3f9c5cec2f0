// SPDX-License-Identifier: Apache-2.0
/// @file
/// A time in which nobody ran on a processor.
#ifndef MAMORI_TIME_FAULTS_STALL_HPP
#define MAMORI_TIME_FAULTS_STALL_HPP

#include <vector>

#include "mamori/kernel/time.hpp"

namespace mamori::time_faults {

/// From one look at the clock to the next, much later one.
struct Stall {
    Instant begin{};
    Instant end{};
};

/// @return whether a stall lies, in part, within the two instants. @param[in] stalls in their order.
bool overlaps(const std::vector<Stall>& stalls, Instant begin, Instant end);

}  // namespace mamori::time_faults

#endif  // MAMORI_TIME_FAULTS_STALL_HPP
