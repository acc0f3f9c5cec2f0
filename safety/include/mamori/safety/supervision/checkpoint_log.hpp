// SPDX-License-Identifier: Apache-2.0
/// @file
/// The way of reports from the context of an entity to whoever supervises it, without a lock.
///
/// @satisfies SWR-SUP-032      Design: docs/design/supervision.md#reports
#ifndef MAMORI_SAFETY_SUPERVISION_CHECKPOINT_LOG_HPP
#define MAMORI_SAFETY_SUPERVISION_CHECKPOINT_LOG_HPP

#include <cstddef>
#include <cstdint>

#include "mamori/kernel/base/time.hpp"
#include "mamori/kernel/dataflow/fifo_buffer.hpp"
#include "mamori/safety/supervision/supervision_table.hpp"

namespace mamori::safety {

/// Reports of one entity that can wait for a supervision cycle. With the two that are in hand, the queue has
/// 32 places of 16 bytes.
inline constexpr std::size_t kPendingCheckpointsMax = 30U;

/// A checkpoint was passed.
struct CheckpointEvent {
    Instant at{};
    CheckpointIndex checkpoint{kNoCheckpoint};
};

/// Reports of one entity.
///
/// Thread safety: report() from the one context of the entity, get_queue() from the one of the supervisor,
///                which may be the same or another, on another core too.
/// Time:          O(1), wait-free. Memory: kPendingCheckpointsMax + 2 events; no heap.
class CheckpointLog final {
  public:
    /// A full queue refuses: what is lost is counted, and the supervisor sees the count.
    using Queue =
        FifoBuffer<CheckpointEvent, kPendingCheckpointsMax, FullPolicy::kDoNothing, EmptyPolicy::kDoNothing>;

    /// Reports that a checkpoint was passed. A report that finds no room expires the entity.
    /// @param[in] checkpoint enumerator of the table. @param[in] now when it was passed, by the clock of the
    ///            supervisor.
    template <typename Checkpoint>
    void report(Checkpoint checkpoint, Instant now) noexcept {
        // The queue counts what it refuses; the entity is not the one to judge it.
        static_cast<void>(queue_.push({now, detail::to_row_number(checkpoint)}));
    }

    /// For the supervisor.
    Queue& get_queue() noexcept { return queue_; }

  private:
    Queue queue_{};
};

}  // namespace mamori::safety

#endif  // MAMORI_SAFETY_SUPERVISION_CHECKPOINT_LOG_HPP
