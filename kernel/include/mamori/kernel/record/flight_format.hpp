// SPDX-License-Identifier: Apache-2.0
/// @file
/// Byte format of a flight recorder region: a header, then a ring of records of equal size, all
/// little-endian. Pure functions that convert between values and bytes, each O(1) and callable from any
/// context. FlightRecorder defines the write order.
///
/// @satisfies SWR-REC-001      Design: docs/design/recorder.md#region
#ifndef MAMORI_KERNEL_FLIGHT_FORMAT_HPP
#define MAMORI_KERNEL_FLIGHT_FORMAT_HPP

#include <array>
#include <cstddef>
#include <cstdint>

#include "mamori/kernel/base/assert.hpp"
#include "mamori/kernel/base/time.hpp"
#include "mamori/kernel/record/event_log.hpp"

namespace mamori {

/// One stored record.
struct FlightRecord {
    std::uint64_t sequence{0U};  ///< 1 .. kSequenceMax over all sessions; a number is never reused
    Instant time{};              ///< in the time base of its session
    std::int64_t argument{0};    ///< meaning depends on the code
    std::uint32_t session{0U};   ///< 1, 2, ...: session that wrote the record
    std::uint16_t source{0U};    ///< as Event::source
    std::uint16_t code{0U};      ///< as Event::code
    Severity severity{Severity::kInfo};
};

/// Content of a slot of the ring.
enum class SlotState : std::uint8_t {
    kEmpty,    ///< never written
    kWhole,    ///< an intact record
    kTorn,     ///< the write was interrupted
    kCorrupt,  ///< written, but modified since, or a record of another slot
};

/// A session: one use of the region from open() to close() or the end of the program. It notes its progress
/// in the header when it starts, and again after each `capacity` records. Until the next note, it
/// uses only numbers below next_sequence + capacity.
struct FlightSession {
    std::uint32_t number{0U};         ///< 1, 2, ...; 0: no session
    std::uint64_t next_sequence{0U};  ///< first number not used when this was noted
};

namespace flight {

inline constexpr std::size_t kHeaderSize = 64U;   ///< [byte]
inline constexpr std::size_t kRecordSize = 40U;   ///< [byte]
inline constexpr std::size_t kSessionSize = 16U;  ///< [byte]
inline constexpr std::uint16_t kVersion = 2U;     ///< version of this layout
/// File signature. It detects a text conversion of the file and the loss of the eighth bit of each byte.
inline constexpr std::array<std::uint8_t, 8U> kMagic{0x89U, 'M', 'R', 'E', 'C', '\r', '\n', 0x1AU};
/// Largest number of a record: 146 years at one record per nanosecond. A larger number is invalid.
inline constexpr std::uint64_t kSequenceMax = std::uint64_t{1} << 62U;

inline constexpr std::size_t kVersionOffset = 8U;  ///< offset in the header [byte]
/// Offsets in the header of the two session slots, which are written alternately [byte]. One has the newest
/// progress note, the other the previous one.
inline constexpr std::array<std::size_t, 2U> kSessionOffsets{24U, 40U};
/// Offset in a record of the commit byte, which is written first as 0 and last as kCommitted [byte].
inline constexpr std::size_t kCommitOffset = 35U;
inline constexpr std::uint8_t kCommitted = 0xC3U;

using HeaderBytes = std::array<std::uint8_t, kHeaderSize>;
using RecordBytes = std::array<std::uint8_t, kRecordSize>;
using SessionBytes = std::array<std::uint8_t, kSessionSize>;

/// Size of a region for `capacity` records [byte]. @param[in] capacity 0 .. 2^32 - 1. Precondition, not
/// checked: the size fits std::size_t.
constexpr std::size_t calc_region_size(std::size_t capacity) noexcept {
    return kHeaderSize + capacity * kRecordSize;
}
/// Number of records that fit into a region of `size` bytes; 0 if it is too small for one. O(1).
constexpr std::size_t calc_capacity(std::size_t size) noexcept {
    return size < kHeaderSize ? 0U : (size - kHeaderSize) / kRecordSize;
}
/// Slot of a record in the ring, 0 .. capacity - 1.
/// @param[in] sequence, capacity >= 1; 0 is a contract violation.
constexpr std::size_t calc_slot(std::uint64_t sequence, std::size_t capacity) noexcept {
    MAMORI_REQUIRE(1, sequence > 0U && capacity > 0U);
    return static_cast<std::size_t>((sequence - 1U) % capacity);
}

/// Encodes a header without a session. @param[in] capacity records in the ring.
HeaderBytes encode_header(std::uint32_t capacity) noexcept;
/// @param[in] capacity records that fit into the region.
/// @return kOk; kUnsupported (other format version); kError (not a recorder region, damaged, or written for
///         another capacity).
Status check_header(const HeaderBytes& bytes, std::size_t capacity) noexcept;

/// @return the bytes, including their checksum.
SessionBytes encode_session(const FlightSession& session) noexcept;
/// @return the session; number 0 if the checksum is wrong or next_sequence is not in 1 .. kSequenceMax.
FlightSession decode_session(const SessionBytes& bytes) noexcept;

/// @return the bytes; the commit byte is still 0.
RecordBytes encode_record(const FlightRecord& record) noexcept;
/// @param[in] slot slot that contained the bytes, 0 .. capacity - 1. @param[out] record written if kWhole.
/// @return kEmpty (only zeros); kTorn (commit byte still 0); kCorrupt (wrong checksum or commit byte, or a
///         value that no record of this slot can have); else kWhole.
SlotState decode_record(const RecordBytes& bytes, std::size_t slot, std::size_t capacity,
                        FlightRecord& record) noexcept;

}  // namespace flight
}  // namespace mamori

#endif  // MAMORI_KERNEL_FLIGHT_FORMAT_HPP
