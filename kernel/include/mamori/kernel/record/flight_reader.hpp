// SPDX-License-Identifier: Apache-2.0
/// @file
/// Reads the records that a flight recorder wrote: after a reset, after a crash, or while it still writes.
///
/// @satisfies SWR-REC-004, SWR-REC-005      Design: docs/design/recorder.md#reading
#ifndef MAMORI_KERNEL_FLIGHT_READER_HPP
#define MAMORI_KERNEL_FLIGHT_READER_HPP

#include <cstddef>
#include <cstdint>

#include "mamori/kernel/base/span.hpp"
#include "mamori/kernel/base/status.hpp"
#include "mamori/kernel/record/flight_format.hpp"

namespace mamori {

/// View of a region with arbitrary content. No value is used before its checksum was verified.
///
/// Thread safety: none against a writer in the same program. A writer in another process is permitted: a
///                record that changes during the read is reported as torn or corrupt.
/// Time:          as stated at each member; nothing blocks. Memory: the view only.
class FlightReader final {
  public:
    constexpr FlightReader() noexcept = default;

    /// @param[in] region must outlive this object; any alignment. O(1).
    /// @return kOk; kBadParameter (smaller than header and one record, or more than 2^32 - 1 records);
    ///         kUnsupported (other format version); kError (not a recorder region, header damaged, or written
    ///         for a region of another size). Unless kOk, the reader is unchanged.
    Status open(Span<const std::byte> region) noexcept;

    /// Slots of the ring; 0 before open().
    std::size_t get_capacity() const noexcept { return capacity_; }

    /// @param[in] slot 0 .. get_capacity() - 1; any other value is a contract violation.
    /// @param[out] record written if kWhole is returned.
    /// @return as flight::decode_record(). O(1).
    SlotState read(std::size_t slot, FlightRecord& record) const noexcept;

    /// Newest session in the header; number 0 if the header has none, or before open(). O(1).
    FlightSession calc_session() const noexcept;
    /// Index into flight::kSessionOffsets of the newest session; 0 if there is none. O(1).
    std::size_t calc_session_place() const noexcept;
    /// Number of the newest intact record; 0 if there is none. O(capacity).
    std::uint64_t calc_newest_sequence() const noexcept;

  private:
    /// @param[in] place 0 or 1: index into flight::kSessionOffsets.
    FlightSession read_session(std::size_t place) const noexcept;

    Span<const std::byte> region_{};
    std::size_t capacity_{0U};
};

}  // namespace mamori

#endif  // MAMORI_KERNEL_FLIGHT_READER_HPP
