// SPDX-License-Identifier: Apache-2.0
/// @file
/// Bytes of a flight recorder's region: a header, then a ring of records of one size, all little-endian. Pure
/// functions between values and bytes, each O(1) and for any context; who writes them in which order is the
/// business of FlightRecorder.
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

/// One record as it is kept.
struct FlightRecord {
    std::uint64_t sequence{0U};  ///< 1 .. kSequenceMax over all sessions; a number is never used twice
    Instant time{};              ///< on the time line of its session
    std::int64_t argument{0};    ///< meaning depends on the code
    std::uint32_t session{0U};   ///< 1, 2, ...: which opening of the region wrote it
    std::uint16_t source{0U};    ///< as Event::source
    std::uint16_t code{0U};      ///< as Event::code
    Severity severity{Severity::kInfo};
};

/// What a slot of the ring holds.
enum class SlotState : std::uint8_t {
    kEmpty,    ///< never written
    kWhole,    ///< a record
    kTorn,     ///< the writer ended in mid-write
    kCorrupt,  ///< written, but changed since, or not of this place
};

/// Which opening of the region is, or was, at work, and how far it had come when it last said so: at its
/// beginning, and before each record that goes into slot 0.
struct FlightSession {
    std::uint32_t number{0U};         ///< 1, 2, ...; 0: none
    std::uint64_t next_sequence{0U};  ///< given to no record yet; this plus the capacity is never given
                                      ///< before the session says so again
};

namespace flight {

inline constexpr std::size_t kHeaderSize = 64U;   ///< [byte]
inline constexpr std::size_t kRecordSize = 40U;   ///< [byte]
inline constexpr std::size_t kSessionSize = 16U;  ///< [byte]
inline constexpr std::uint16_t kVersion = 2U;     ///< of this layout
/// A file that went through a text conversion, or lost its eighth bits, no longer begins like this.
inline constexpr std::array<std::uint8_t, 8U> kMagic{0x89U, 'M', 'R', 'E', 'C', '\r', '\n', 0x1AU};
/// Largest number of a record: 146 years at one record per nanosecond. A larger one is no number of ours.
inline constexpr std::uint64_t kSequenceMax = std::uint64_t{1} << 62U;

inline constexpr std::size_t kVersionOffset = 8U;  ///< in the header [byte]
/// Of the two places for the session in the header [byte]: what it says now and what it said before, in
/// turns.
inline constexpr std::array<std::size_t, 2U> kSessionOffsets{24U, 40U};
/// Byte of a record [byte] that is written first, as 0, and last, as kCommitted.
inline constexpr std::size_t kCommitOffset = 35U;
inline constexpr std::uint8_t kCommitted = 0xC3U;

using HeaderBytes = std::array<std::uint8_t, kHeaderSize>;
using RecordBytes = std::array<std::uint8_t, kRecordSize>;
using SessionBytes = std::array<std::uint8_t, kSessionSize>;

/// Bytes of a region that holds `capacity` records. @param[in] capacity 0 .. 2^32 - 1, as far as std::size_t
/// counts the bytes: that is not checked.
constexpr std::size_t calc_region_size(std::size_t capacity) noexcept {
    return kHeaderSize + capacity * kRecordSize;
}
/// Records that a region of `size` bytes holds; 0 when it is too small for one. O(1).
constexpr std::size_t calc_capacity(std::size_t size) noexcept {
    return size < kHeaderSize ? 0U : (size - kHeaderSize) / kRecordSize;
}
/// Place of a record in the ring, 0 .. capacity - 1.
/// @param[in] sequence from 1 on; else an own bug. @param[in] capacity from 1 on; else an own bug.
constexpr std::size_t calc_slot(std::uint64_t sequence, std::size_t capacity) noexcept {
    MAMORI_REQUIRE(1, sequence > 0U && capacity > 0U);
    return static_cast<std::size_t>((sequence - 1U) % capacity);
}

/// A header without any session. @param[in] capacity records in the ring.
HeaderBytes encode_header(std::uint32_t capacity) noexcept;
/// @param[in] capacity records that the region at hand has room for.
/// @return kOk; kUnsupported (of another version); kError (foreign, damaged, or for another capacity).
Status check_header(const HeaderBytes& bytes, std::size_t capacity) noexcept;

/// @return the bytes, their checksum among them.
SessionBytes encode_session(const FlightSession& session) noexcept;
/// @return the session; number 0 when the bytes hold none that is whole.
FlightSession decode_session(const SessionBytes& bytes) noexcept;

/// @return the bytes with the commit byte still 0.
RecordBytes encode_record(const FlightRecord& record) noexcept;
/// @param[in] slot place where the bytes were found, 0 .. capacity - 1. @param[out] record set when kWhole.
/// @return kEmpty (zeros only); kTorn (the commit byte is still 0); kCorrupt (the checksum, or a value that
///         no record of this place has); else kWhole.
SlotState decode_record(const RecordBytes& bytes, std::size_t slot, std::size_t capacity,
                        FlightRecord& record) noexcept;

}  // namespace flight
}  // namespace mamori

#endif  // MAMORI_KERNEL_FLIGHT_FORMAT_HPP
