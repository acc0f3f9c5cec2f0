// SPDX-License-Identifier: Apache-2.0
/// @file
/// Reception status of a receiver in each cycle. The supervision uses it to detect missing, too many and old
/// messages.
///
/// @satisfies SWR-PRT-013      Design: docs/design/posix_rt.md#partitions
#ifndef MAMORI_PORTS_POSIX_RT_PARTITION_NEWS_HPP
#define MAMORI_PORTS_POSIX_RT_PARTITION_NEWS_HPP

#include <cstdint>

#include "mamori/kernel/payload/cdr_scalar.hpp"
#include "mamori/kernel/payload/fields.hpp"
#include "mamori/ports/posix_rt/shared_frame.hpp"

namespace mamori::ports::posix_rt {

/// Reception status of one cycle, for the component that supervises the other partition.
struct PartitionNews {
    FrameOutcome outcome{FrameOutcome::kNothingNew};
    std::uint64_t number{0U};   ///< number of the last valid message; 0: none
    std::uint64_t skipped{0U};  ///< messages missed since the previous valid one; kNew only
    std::int64_t age_ns{0};     ///< time from publication in the other partition; kNew only
    std::uint32_t refused{0U};  ///< torn and malformed messages so far; saturates
};

}  // namespace mamori::ports::posix_rt

MAMORI_LAST_ENUMERATOR(mamori::ports::posix_rt::FrameOutcome, kMalformed)
MAMORI_FIELDS(mamori::ports::posix_rt::PartitionNews, outcome, number, skipped, age_ns, refused)

#endif  // MAMORI_PORTS_POSIX_RT_PARTITION_NEWS_HPP
