// SPDX-License-Identifier: Apache-2.0
/// @file
/// Counts of events, for every part of the safety layer.
///
/// @satisfies SWR-E2E-005      Design: docs/design/e2e.md#causes
#ifndef MAMORI_SAFETY_COUNT_UP_HPP
#define MAMORI_SAFETY_COUNT_UP_HPP

#include <cstdint>
#include <limits>

namespace mamori::safety {

/// Counts up and stops at the greatest value: a count that wraps to small values looks like health.
constexpr void count_up(std::uint32_t& count) noexcept {
    if (count < std::numeric_limits<std::uint32_t>::max()) {
        ++count;
    }
}

}  // namespace mamori::safety

#endif  // MAMORI_SAFETY_COUNT_UP_HPP
