// SPDX-License-Identifier: Apache-2.0
/// @file
/// Flight recorder: a ring of numbered, checksummed records in memory that survives the program, such as a
/// mapped file or RAM that a reset retains. Records that were written before the end can be read after it.
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

/// Writes records to a region of its owner, which must outlive the recorder. An event log can forward its
/// events to it.
///
/// Thread safety: none; one recorder per context, one recorder per region.
/// Time:          write() is O(1), wait-free; open() and format() are O(region). Nothing blocks, except that
///                the operating system may delay the first access to a page: see
///                docs/design/recorder.md#mapped-file.
/// Memory:        none of its own beyond the counters.
class FlightRecorder final {
  public:
    constexpr FlightRecorder() noexcept = default;

    /// Formats the region as an empty recorder and erases its content. A recorder that is open over the
    /// region must not be used afterwards.
    /// @return kOk; kBadParameter (capacity is 0 records, or more than 2^32 - 1).
    static Status format(Span<std::byte> region) noexcept;

    /// Starts a session. Formats a region that contains only zeros, or whose first format was interrupted. In
    /// any other region, it keeps the records and continues their numbers.
    /// @param[in] region any alignment; must outlive this object.
    /// @return kOk; kBadParameter (capacity is 0 records, or more than 2^32 - 1); kPreconditionNotMet
    ///         (already open); kUnsupported (other format version); kError (not a recorder region, header
    ///         damaged, written for another size, or so damaged that neither header nor records show which
    ///         numbers were used); kOutOfResources (numbers of records or sessions exhausted). Unless kOk,
    ///         region and recorder are unchanged; the caller decides whether to format().
    Status open(Span<std::byte> region) noexcept;

    /// Ends the session; the region can then be released.
    void close() noexcept { *this = FlightRecorder{}; }
    bool is_open() const noexcept { return capacity_ != 0U; }

    /// Appends a record. When it returns, the record survives the end of the program. An end during the write
    /// leaves all other records intact and a slot that reads as torn. A call while closed is a contract
    /// violation.
    void write(Instant time, Severity severity, std::uint16_t source, std::uint16_t code,
               std::int64_t argument) noexcept;

    /// Number of the session, >= 1; 0 while closed.
    std::uint32_t get_session() const noexcept { return session_; }
    /// Number of the next record, >= 1; 0 while closed.
    std::uint64_t get_next_sequence() const noexcept { return next_sequence_; }
    /// Records of this and earlier sessions that this session overwrote; 0 while closed.
    std::uint64_t get_overwritten_count() const noexcept { return overwritten_count_; }

  private:
    /// Records session and next_sequence_ in the header, in the slot that does not contain the newest note.
    void note_progress() noexcept;

    Span<std::byte> region_{};
    std::size_t capacity_{0U};
    std::size_t next_slot_{0U};   ///< slot of next_sequence_; avoids a division per record
    std::size_t note_place_{0U};  ///< index into flight::kSessionOffsets of the next note
    std::uint32_t session_{0U};
    std::uint64_t next_sequence_{0U};
    std::uint64_t noted_until_{0U};  ///< the newest note in the header covers the numbers below this one
    std::uint64_t overwritten_count_{0U};
};

}  // namespace mamori

#endif  // MAMORI_KERNEL_FLIGHT_RECORDER_HPP
