// SPDX-License-Identifier: Apache-2.0
/// @file
/// Bounded log of numbered events. Records are numbers, not strings: the tables that name them stay on the
/// host. When it is full the oldest record gives way and is counted as lost.
///
/// @satisfies SWR-KRN-019, SWR-REC-009      Design: docs/design/kernel.md#event-log
#ifndef MAMORI_KERNEL_EVENT_LOG_HPP
#define MAMORI_KERNEL_EVENT_LOG_HPP

#include <cstddef>
#include <cstdint>

#include "mamori/kernel/base/span.hpp"
#include "mamori/kernel/base/status.hpp"
#include "mamori/kernel/base/time.hpp"

namespace mamori {

class FlightRecorder;

/// How much an event matters.
enum class Severity : std::uint8_t { kInfo, kWarning, kFault };

/// One record.
struct Event {
    std::uint32_t sequence{0U};  ///< 0, 1, 2, ... without a gap at writing; wraps at 2^32
    Severity severity{Severity::kInfo};
    std::uint16_t source{0U};  ///< who: component index or a number of the application
    std::uint16_t code{0U};    ///< what: number of the application's event table
    Instant time{};
    std::int64_t argument{0};  ///< meaning depends on the code
};

/// Ring of events over storage given by its owner, which must outlive it.
///
/// Thread safety: none; one log per context. Time: O(1), with a recorder too.
/// Memory:        none of its own beyond the counters.
class EventLog final {
  public:
    /// @param[in] storage room for the records; with none at all every write is a lost record.
    constexpr explicit EventLog(Span<Event> storage) noexcept : storage_(storage) {}

    /// Hands every later record on to a recorder as well, which outlives the program; for a start without one
    /// nothing needs to be called. @param[in] recorder open, and to be left open until the last write; must
    /// outlive the log.
    /// @return kOk; kPreconditionNotMet (the recorder is not open, or there is one already).
    Status attach(FlightRecorder& recorder) noexcept;

    /// Appends a record, in the recorder first; never fails, never blocks. A recorder that was attached and
    /// is closed since is an own bug.
    void write(Instant time, Severity severity, std::uint16_t source, std::uint16_t code,
               std::int64_t argument) noexcept;

    /// Records that can be read, 0 .. capacity.
    std::size_t size() const noexcept;
    /// @param[in] index 0 = oldest kept .. size() - 1 = newest.
    /// @return valid until the next write; an index out of range is an own bug.
    const Event& get(std::size_t index) const noexcept;
    /// Records that gave way to later ones, read or not, or found no room at all (saturates at 2^32 - 1).
    std::uint32_t get_lost_count() const noexcept { return lost_count_; }

  private:
    Span<Event> storage_;
    FlightRecorder* recorder_{nullptr};
    std::uint32_t written_count_{0U};
    std::uint32_t lost_count_{0U};
    std::size_t next_index_{0U};
    std::size_t kept_count_{0U};
};

}  // namespace mamori

#endif  // MAMORI_KERNEL_EVENT_LOG_HPP
