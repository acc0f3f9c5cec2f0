// SPDX-License-Identifier: Apache-2.0
#include "mamori/kernel/record/flight_reader.hpp"

#include <limits>

namespace mamori {
namespace {

/// Copies the bytes once, so that checked and used values are equal even if another process writes.
template <std::size_t N>
std::array<std::uint8_t, N> copy(Span<const std::byte> region, std::size_t offset) noexcept {
    const Span<const std::byte> part = region.subspan(offset, N);
    const volatile std::byte* from = part.data();
    std::array<std::uint8_t, N> bytes{};
    for (std::size_t i = 0U; i < N; ++i) {
        const std::byte byte = from[i];
        bytes[i] = std::to_integer<std::uint8_t>(byte);
    }
    return bytes;
}

}  // namespace

Status FlightReader::open(Span<const std::byte> region) noexcept {
    const std::size_t capacity = flight::calc_capacity(region.size());
    if (capacity == 0U || capacity > std::numeric_limits<std::uint32_t>::max()) {
        return Status::kBadParameter;
    }
    const Status status = flight::check_header(copy<flight::kHeaderSize>(region, 0U), capacity);
    if (status == Status::kOk) {
        region_ = region;
        capacity_ = capacity;
    }
    return status;
}

SlotState FlightReader::read(std::size_t slot, FlightRecord& record) const noexcept {
    MAMORI_REQUIRE(1, slot < capacity_);
    const std::size_t offset = flight::calc_region_size(slot);
    return flight::decode_record(copy<flight::kRecordSize>(region_, offset), slot, capacity_, record);
}

FlightSession FlightReader::read_session(std::size_t place) const noexcept {
    if (capacity_ == 0U) {
        return {};
    }
    return flight::decode_session(copy<flight::kSessionSize>(region_, flight::kSessionOffsets[place]));
}

std::size_t FlightReader::calc_session_place() const noexcept {
    const FlightSession first = read_session(0U);
    const FlightSession second = read_session(1U);
    const bool is_second_newer = second.number != first.number ? second.number > first.number
                                                               : second.next_sequence > first.next_sequence;
    return is_second_newer ? 1U : 0U;
}

FlightSession FlightReader::calc_session() const noexcept {
    return read_session(calc_session_place());
}

std::uint64_t FlightReader::calc_newest_sequence() const noexcept {
    std::uint64_t newest = 0U;
    FlightRecord record{};
    for (std::size_t slot = 0U; slot < capacity_; ++slot) {
        if (read(slot, record) == SlotState::kWhole && record.sequence > newest) {
            newest = record.sequence;
        }
    }
    return newest;
}

}  // namespace mamori
