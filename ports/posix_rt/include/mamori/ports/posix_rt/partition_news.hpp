// SPDX-License-Identifier: Apache-2.0
/// @file
/// What a receiver of frames tells about each of its cycles: the facts from which silence, floods and old
/// messages are judged.
///
/// @satisfies SWR-PRT-013      Design: docs/design/posix_rt.md#partitions
#ifndef MAMORI_PORTS_POSIX_RT_PARTITION_NEWS_HPP
#define MAMORI_PORTS_POSIX_RT_PARTITION_NEWS_HPP

#include <cstdint>

#include "mamori/kernel/payload/cdr_scalar.hpp"
#include "mamori/kernel/payload/fields.hpp"
#include "mamori/ports/posix_rt/shared_frame.hpp"

namespace mamori::ports::posix_rt {

/// What a receiver has to say about each of its cycles, for whoever supervises the other partition.
struct PartitionNews {
    FrameOutcome outcome{FrameOutcome::kNothingNew};
    std::uint64_t number{0U};   ///< of the last good frame; 0: there was none
    std::uint64_t skipped{0U};  ///< by its number, frames since the good one before that were not; kNew only
    std::int64_t age_ns{0};     ///< from the publication in the other partition to this cycle; kNew only
    std::uint32_t refused{0U};  ///< torn and malformed ones so far; held at the largest number
};

}  // namespace mamori::ports::posix_rt

MAMORI_LAST_ENUMERATOR(mamori::ports::posix_rt::FrameOutcome, kMalformed)
MAMORI_FIELDS(mamori::ports::posix_rt::PartitionNews, outcome, number, skipped, age_ns, refused)

#endif  // MAMORI_PORTS_POSIX_RT_PARTITION_NEWS_HPP
