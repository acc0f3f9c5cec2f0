// SPDX-License-Identifier: Apache-2.0
/// @file
/// Reads what a flight recorder left: after a reset, after a crash, or while it is still being written.
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

/// View of a region that may hold any bytes at all. Nothing is believed before its checksum was right.
///
/// Thread safety: none against a writer in the same program; a writer in another process is fine, a record
/// that changes while it is read shows as torn or corrupt. Time: as said at each member; nothing blocks.
/// Memory: the view alone.
class FlightReader final {
  public:
    constexpr FlightReader() noexcept = default;

    /// @param[in] region must outlive this object; any alignment. O(1).
    /// @return kOk; kBadParameter (smaller than header and one record, or more than 2^32 - 1 records);
    ///         kUnsupported (a recorder of another format version); kError (foreign, damaged header, or
    ///         written for a region of another size). On anything but kOk the reader stays as it was.
    Status open(Span<const std::byte> region) noexcept;

    /// Slots of the ring; 0 before open().
    std::size_t get_capacity() const noexcept { return capacity_; }

    /// @param[in] slot 0 .. get_capacity() - 1; anything else is an own bug.
    /// @param[out] record set when kWhole.
    /// @return as flight::decode_record(). O(1).
    SlotState read(std::size_t slot, FlightRecord& record) const noexcept;

    /// The newest that the header knows of a session; number 0 when it knows none, or before open(). O(1).
    FlightSession calc_session() const noexcept;
    /// Which of flight::kSessionOffsets tells of it; 0 when neither does. O(1).
    std::size_t calc_session_place() const noexcept;
    /// Number of the newest whole record, 0 without one. O(capacity).
    std::uint64_t calc_newest_sequence() const noexcept;

  private:
    /// @param[in] place 0 or 1: index into flight::kSessionOffsets.
    FlightSession read_session(std::size_t place) const noexcept;

    Span<const std::byte> region_{};
    std::size_t capacity_{0U};
};

}  // namespace mamori

#endif  // MAMORI_KERNEL_FLIGHT_READER_HPP
