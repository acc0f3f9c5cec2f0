// SPDX-License-Identifier: Apache-2.0
/// @file
/// Flight recorder: a ring of numbered, checksummed records in memory that outlives the program, such as a
/// mapped file or RAM that a reset leaves alone. What was written before the end can be read after it.
///
/// @satisfies SWR-REC-002, SWR-REC-003, SWR-REC-006, SWR-REC-007, SWR-REC-008, SWR-REC-015
/// Design: docs/design/recorder.md#writing
#ifndef MAMORI_KERNEL_FLIGHT_RECORDER_HPP
#define MAMORI_KERNEL_FLIGHT_RECORDER_HPP

#include <cstddef>
#include <cstdint>

#include "mamori/kernel/base/span.hpp"
#include "mamori/kernel/base/status.hpp"
#include "mamori/kernel/record/flight_format.hpp"

namespace mamori {

/// Writes records over a region given by its owner, which must outlive it. An event log can hand its events
/// on to it.
///
/// Thread safety: none; one recorder per context, one recorder per region.
/// Time:          write() is O(1), wait-free; open() and format() are O(region). Nothing blocks, but the
///                first touch of a page is the system's business: see docs/design/recorder.md#mapped-file.
/// Memory:        none of its own beyond the counters.
class FlightRecorder final {
  public:
    constexpr FlightRecorder() noexcept = default;

    /// Makes an empty recorder of the region and wipes whatever it held. A recorder that is open over the
    /// region must not be used afterwards.
    /// @return kOk; kBadParameter (room for no record, or for more than 2^32 - 1).
    static Status format(Span<std::byte> region) noexcept;

    /// Begins a session: formats a region of zeros only, also one whose first format was cut off; continues
    /// the numbers of any other and keeps its records.
    /// @param[in] region any alignment; must outlive this object.
    /// @return kOk; kBadParameter (room for no record, or for more than 2^32 - 1);
    ///         kPreconditionNotMet (open already); kUnsupported (written by another format version); kError
    ///         (foreign, damaged header, written for another size, or damaged so that neither header nor any
    ///         record tells which numbers were given); kOutOfResources (numbers of records or sessions used
    ///         up). Unless kOk, neither region nor recorder was changed: the caller decides about format().
    Status open(Span<std::byte> region) noexcept;

    /// Ends the session; the region may go.
    void close() noexcept { *this = FlightRecorder{}; }
    bool is_open() const noexcept { return capacity_ != 0U; }

    /// Appends a record. When it returns, the end of the program takes it no more; an end in mid-write leaves
    /// all other records and a slot that reads as torn. Without an open region it is an own bug.
    void write(Instant time, Severity severity, std::uint16_t source, std::uint16_t code,
               std::int64_t argument) noexcept;

    /// Number of the session, from 1 on; 0 while closed.
    std::uint32_t get_session() const noexcept { return session_; }
    /// Number that the next record gets, from 1 on; 0 while closed.
    std::uint64_t get_next_sequence() const noexcept { return next_sequence_; }
    /// Records of this and earlier sessions that gave way to one of this session; 0 while closed.
    std::uint64_t get_overwritten_count() const noexcept { return overwritten_count_; }

  private:
    /// Notes in the header that next_sequence_ comes next, in the place that does not hold the newest note.
    void note_progress() noexcept;

    Span<std::byte> region_{};
    std::size_t capacity_{0U};
    std::size_t next_slot_{0U};   ///< that of next_sequence_: no division when a record is written
    std::size_t note_place_{0U};  ///< index into flight::kSessionOffsets of the next note
    std::uint32_t session_{0U};
    std::uint64_t next_sequence_{0U};
    std::uint64_t noted_until_{0U};  ///< the newest note in the header covers the numbers below this one
    std::uint64_t overwritten_count_{0U};
};

}  // namespace mamori

#endif  // MAMORI_KERNEL_FLIGHT_RECORDER_HPP
