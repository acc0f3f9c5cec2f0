// SPDX-License-Identifier: Apache-2.0
/// @file
/// Limits of the duration of a run, for the supervision of components and of checkpoints.
///
/// @satisfies SWR-SUP-003      Design: docs/design/supervision.md#deadline-supervision
/// Source:   IEC 61508-2:2010 Table A.10 (temporal monitoring of program sequence)
#ifndef MAMORI_SAFETY_DEADLINE_LIMITS_HPP
#define MAMORI_SAFETY_DEADLINE_LIMITS_HPP

#include "mamori/kernel/base/time.hpp"

namespace mamori::safety {

/// Allowed duration of one run, both ends included. Range: 0 <= shortest <= longest, 0 < longest.
struct DeadlineLimits {
    Duration shortest{0};
    Duration longest{0};
};

/// True when the limits are inside their range.
constexpr bool is_valid(DeadlineLimits limits) noexcept {
    return limits.shortest >= Duration{0} && limits.shortest <= limits.longest &&
           limits.longest > Duration{0};
}

}  // namespace mamori::safety

#endif  // MAMORI_SAFETY_DEADLINE_LIMITS_HPP
