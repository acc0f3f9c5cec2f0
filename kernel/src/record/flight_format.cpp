// SPDX-License-Identifier: Apache-2.0
#include "mamori/kernel/record/flight_format.hpp"

#include <type_traits>

#include "mamori/kernel/base/crc32.hpp"
#include "mamori/kernel/base/span.hpp"

namespace mamori::flight {
namespace {

constexpr std::size_t kHeaderCrcOffset = 20U;
constexpr std::size_t kSessionCrcOffset = 12U;
constexpr std::size_t kRecordCrcOffset = 36U;

/// Writes `value` at `offset`, lowest byte first, independent of the byte order of the processor.
template <typename T, std::size_t N>
void put(std::array<std::uint8_t, N>& bytes, std::size_t offset, T value) noexcept {
    using Bits = std::make_unsigned_t<T>;
    const auto bits = static_cast<std::uint64_t>(static_cast<Bits>(value));
    for (std::size_t i = 0U; i < sizeof value; ++i) {
        bytes[offset + i] = static_cast<std::uint8_t>((bits >> (8U * i)) & 0xFFU);
    }
}

template <typename T, std::size_t N>
T get(const std::array<std::uint8_t, N>& bytes, std::size_t offset) noexcept {
    std::uint64_t bits = 0U;
    for (std::size_t i = 0U; i < sizeof(T); ++i) {
        bits |= static_cast<std::uint64_t>(bytes[offset + i]) << (8U * i);
    }
    return static_cast<T>(bits);
}

/// Checksum (CRC-32) of the first `count` bytes.
std::uint32_t calc_crc(Span<const std::uint8_t> bytes, std::size_t count) noexcept {
    Crc32 crc;
    for (const std::uint8_t byte : bytes.subspan(0U, count)) {
        crc.add(byte);
    }
    return crc.get_value();
}

bool is_all_zero(const RecordBytes& bytes) noexcept {
    std::uint8_t seen = 0U;
    for (const std::uint8_t byte : bytes) {
        seen = static_cast<std::uint8_t>(seen | byte);
    }
    return seen == 0U;
}

}  // namespace

HeaderBytes encode_header(std::uint32_t capacity) noexcept {
    HeaderBytes bytes{};
    for (std::size_t i = 0U; i < kMagic.size(); ++i) {
        bytes[i] = kMagic[i];
    }
    put(bytes, kVersionOffset, kVersion);
    put(bytes, 10U, static_cast<std::uint16_t>(kHeaderSize));
    put(bytes, 12U, static_cast<std::uint16_t>(kRecordSize));
    put(bytes, 16U, capacity);
    put(bytes, kHeaderCrcOffset, calc_crc(bytes, kHeaderCrcOffset));
    return bytes;
}

Status check_header(const HeaderBytes& bytes, std::size_t capacity) noexcept {
    for (std::size_t i = 0U; i < kMagic.size(); ++i) {
        if (bytes[i] != kMagic[i]) {
            return Status::kError;
        }
    }
    // Another format version may define all bytes after the version differently, including the checksum.
    if (get<std::uint16_t>(bytes, kVersionOffset) != kVersion) {
        return Status::kUnsupported;
    }
    const HeaderBytes wanted = encode_header(static_cast<std::uint32_t>(capacity));
    for (std::size_t i = 0U; i < kSessionOffsets[0]; ++i) {
        if (bytes[i] != wanted[i]) {
            return Status::kError;
        }
    }
    return Status::kOk;
}

SessionBytes encode_session(const FlightSession& session) noexcept {
    SessionBytes bytes{};
    put(bytes, 0U, session.next_sequence);
    put(bytes, 8U, session.number);
    put(bytes, kSessionCrcOffset, calc_crc(bytes, kSessionCrcOffset));
    return bytes;
}

FlightSession decode_session(const SessionBytes& bytes) noexcept {
    const FlightSession session{get<std::uint32_t>(bytes, 8U), get<std::uint64_t>(bytes, 0U)};
    const bool is_whole = get<std::uint32_t>(bytes, kSessionCrcOffset) == calc_crc(bytes, kSessionCrcOffset);
    const bool is_possible = session.next_sequence >= 1U && session.next_sequence <= kSequenceMax;
    return is_whole && is_possible ? session : FlightSession{};
}

RecordBytes encode_record(const FlightRecord& record) noexcept {
    RecordBytes bytes{};
    put(bytes, 0U, record.sequence);
    put(bytes, 8U, record.time.ns);
    put(bytes, 16U, record.argument);
    put(bytes, 24U, record.session);
    put(bytes, 28U, record.source);
    put(bytes, 30U, record.code);
    put(bytes, 32U, static_cast<std::uint8_t>(record.severity));
    put(bytes, kRecordCrcOffset, calc_crc(bytes, kCommitOffset));
    return bytes;
}

SlotState decode_record(const RecordBytes& bytes, std::size_t slot, std::size_t capacity,
                        FlightRecord& record) noexcept {
    if (bytes[kCommitOffset] == 0U) {
        return is_all_zero(bytes) ? SlotState::kEmpty : SlotState::kTorn;
    }
    const auto sequence = get<std::uint64_t>(bytes, 0U);
    const auto severity = get<std::uint8_t>(bytes, 32U);
    if (bytes[kCommitOffset] != kCommitted ||
        get<std::uint32_t>(bytes, kRecordCrcOffset) != calc_crc(bytes, kCommitOffset) || sequence == 0U ||
        sequence > kSequenceMax || calc_slot(sequence, capacity) != slot ||
        severity > static_cast<std::uint8_t>(Severity::kFault)) {
        return SlotState::kCorrupt;
    }
    record.sequence = sequence;
    record.time = Instant{get<std::int64_t>(bytes, 8U)};
    record.argument = get<std::int64_t>(bytes, 16U);
    record.session = get<std::uint32_t>(bytes, 24U);
    record.source = get<std::uint16_t>(bytes, 28U);
    record.code = get<std::uint16_t>(bytes, 30U);
    record.severity = static_cast<Severity>(severity);
    return SlotState::kWhole;
}

}  // namespace mamori::flight
