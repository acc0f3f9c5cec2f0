// SPDX-License-Identifier: Apache-2.0
#include "stall.hpp"

#include <algorithm>

namespace mamori::time_faults {

bool overlaps(const std::vector<Stall>& stalls, Instant begin, Instant end) {
    const auto first = std::lower_bound(stalls.begin(), stalls.end(), begin,
                                        [](const Stall& stall, Instant at) { return stall.end < at; });
    return first != stalls.end() && first->begin <= end;
}

}  // namespace mamori::time_faults
