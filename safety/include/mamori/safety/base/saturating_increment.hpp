// SPDX-License-Identifier: Apache-2.0
/// @file
/// Increment of an event counter without wrap-around.
///
/// @satisfies SWR-E2E-005      Design: docs/design/e2e.md#causes
#ifndef MAMORI_SAFETY_SATURATING_INCREMENT_HPP
#define MAMORI_SAFETY_SATURATING_INCREMENT_HPP

#include <cstdint>
#include <limits>

namespace mamori::safety {

/// Adds 1 unless `count` has its greatest value: a counter that wraps to a small value would hide failures.
constexpr void saturating_increment(std::uint32_t& count) noexcept {
    if (count < std::numeric_limits<std::uint32_t>::max()) {
        ++count;
    }
}

}  // namespace mamori::safety

#endif  // MAMORI_SAFETY_SATURATING_INCREMENT_HPP
