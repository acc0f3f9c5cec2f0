// SPDX-License-Identifier: Apache-2.0
/// @file
/// Bounded log of numbered events. Records are numbers, not strings; the tables with their names stay on the
/// host. When the log is full, a new record overwrites the oldest one, which is counted as lost.
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

/// Severity of an event.
enum class Severity : std::uint8_t { kInfo, kWarning, kFault };

/// One record.
struct Event {
    std::uint32_t sequence{0U};  ///< 0, 1, 2, ... without gaps when written; wraps at 2^32
    Severity severity{Severity::kInfo};
    std::uint16_t source{0U};  ///< origin: component index or a number of the application
    std::uint16_t code{0U};    ///< event number in the event table of the application
    Instant time{};
    std::int64_t argument{0};  ///< meaning depends on the code
};

/// Ring buffer of events in storage of its owner, which must outlive the log.
///
/// Thread safety: none; one log per context. Time: O(1), also with a recorder. Nothing blocks.
/// Memory:        none of its own beyond the counters.
class EventLog final {
  public:
    /// @param[in] storage buffer of the records; if it is empty, every written record is lost.
    constexpr explicit EventLog(Span<Event> storage) noexcept : storage_(storage) {}

    /// Forwards every later record also to a recorder, whose region survives the program. A log without a
    /// recorder needs no call. @param[in] recorder must be open, remain open until the last write, and
    /// outlive the log.
    /// @return kOk; kPreconditionNotMet (the recorder is not open, or a recorder is already attached).
    Status attach(FlightRecorder& recorder) noexcept;

    /// Appends a record, first to the recorder; never fails, never blocks. If an attached recorder was closed
    /// since, the call is a contract violation.
    void write(Instant time, Severity severity, std::uint16_t source, std::uint16_t code,
               std::int64_t argument) noexcept;

    /// Records that can be read, 0 .. capacity.
    std::size_t size() const noexcept;
    /// @param[in] index 0 = oldest kept .. size() - 1 = newest; out of range is a contract violation.
    /// @return the record; valid until the next write.
    const Event& get(std::size_t index) const noexcept;
    /// Records that were overwritten, read or not, or not stored for lack of storage (saturates at 2^32 - 1).
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
