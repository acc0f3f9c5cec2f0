// SPDX-License-Identifier: Apache-2.0
#include "mamori/kernel/record/flight_recorder.hpp"

#include <atomic>
#include <limits>

#include "mamori/kernel/record/flight_reader.hpp"

namespace mamori {
namespace {

/// Volatile stores are neither removed nor reordered by the compiler; a reader after the end of the program
/// relies on this.
void store(std::byte& place, std::uint8_t value) noexcept {
    volatile std::byte& stored = place;
    stored = std::byte{value};
}

template <std::size_t N>
void store(Span<std::byte> region, std::size_t offset, const std::array<std::uint8_t, N>& bytes) noexcept {
    volatile std::byte* const place = region.subspan(offset, N).data();
    for (std::size_t i = 0U; i < N; ++i) {
        place[i] = std::byte{bytes[i]};
    }
}

/// Orders the stores before it ahead of the stores after it, on processors with weak memory order.
void order_stores() noexcept {
    std::atomic_thread_fence(std::memory_order_release);
}

bool is_blank(Span<const std::byte> region) noexcept {
    for (const std::byte byte : region) {
        if (byte != std::byte{0U}) {
            return false;
        }
    }
    return true;
}

/// Whether the first format of a zeroed region never started or was interrupted. format() stores the header
/// from its end to its start, so the first bytes are missing and only zeros follow the header.
bool is_never_formatted(Span<const std::byte> region) noexcept {
    if (region.size() < flight::kHeaderSize) {
        return is_blank(region);
    }
    const Span<const std::byte> records =
        region.subspan(flight::kHeaderSize, region.size() - flight::kHeaderSize);
    const flight::HeaderBytes header =
        flight::encode_header(static_cast<std::uint32_t>(flight::calc_capacity(region.size())));
    std::size_t missing = 0U;
    for (std::size_t i = 0U; i < header.size() && region[i] == std::byte{0U}; ++i) {
        missing = i + 1U;
    }
    for (std::size_t i = missing; i < header.size(); ++i) {
        if (region[i] != std::byte{header[i]}) {
            return false;
        }
    }
    return missing > 0U && is_blank(records);
}

/// Newest session in header or records, with the newest progress note of the header. Number 0: none.
FlightSession find_newest(const FlightReader& reader) noexcept {
    FlightSession newest = reader.calc_session();
    FlightRecord record{};
    for (std::size_t slot = 0U; slot < reader.get_capacity(); ++slot) {
        if (reader.read(slot, record) == SlotState::kWhole && record.session > newest.number) {
            newest.number = record.session;
        }
    }
    return newest;
}

bool is_without_slot_in_use(const FlightReader& reader) noexcept {
    FlightRecord record{};
    for (std::size_t slot = 0U; slot < reader.get_capacity(); ++slot) {
        if (reader.read(slot, record) != SlotState::kEmpty) {
            return false;
        }
    }
    return true;
}

/// Number of the next record: greater than all readable ones and not less than the newest note of the header.
/// It also skips the following unreadable slots, since their numbers may have been used. At most `capacity`
/// numbers were used after the note, so no number is reused even if no record is readable.
std::uint64_t find_next_sequence(const FlightReader& reader, std::uint64_t noted) noexcept {
    const std::uint64_t newest = reader.calc_newest_sequence();
    std::uint64_t next = newest < noted ? noted : newest + 1U;
    FlightRecord record{};
    for (std::size_t i = 0U; i < reader.get_capacity(); ++i) {
        const SlotState state = reader.read(flight::calc_slot(next, reader.get_capacity()), record);
        // In the first lap of the ring, a slot is empty until its number is used. Later, an empty slot was
        // erased.
        const bool is_unwritten = state == SlotState::kEmpty && next <= reader.get_capacity();
        if (state == SlotState::kWhole || is_unwritten) {
            break;
        }
        ++next;
    }
    return next;
}

}  // namespace

Status FlightRecorder::format(Span<std::byte> region) noexcept {
    const std::size_t capacity = flight::calc_capacity(region.size());
    if (capacity == 0U || capacity > std::numeric_limits<std::uint32_t>::max()) {
        return Status::kBadParameter;
    }
    // The first bytes are erased first and written last: a partly formatted region is not treated as a
    // recorder, and open() formats it again if it contained only zeros.
    for (std::byte& place : region) {
        store(place, 0U);
    }
    order_stores();
    const flight::HeaderBytes header = flight::encode_header(static_cast<std::uint32_t>(capacity));
    for (std::size_t offset = header.size(); offset > 0U; --offset) {
        store(region[offset - 1U], header[offset - 1U]);
    }
    return Status::kOk;
}

Status FlightRecorder::open(Span<std::byte> region) noexcept {
    if (is_open()) {
        return Status::kPreconditionNotMet;
    }
    const Span<const std::byte> bytes{region.data(), region.size()};
    if (is_never_formatted(bytes)) {
        const Status formatted = format(region);
        if (formatted != Status::kOk) {
            return formatted;
        }
    }
    FlightReader reader;
    const Status status = reader.open(bytes);
    if (status != Status::kOk) {
        return status;
    }
    const FlightSession before = find_newest(reader);
    if (before.number == 0U && !is_without_slot_in_use(reader)) {
        return Status::kError;
    }
    const std::uint64_t next = find_next_sequence(reader, before.next_sequence);
    if (next > flight::kSequenceMax || before.number == std::numeric_limits<std::uint32_t>::max()) {
        return Status::kOutOfResources;
    }
    region_ = region;
    capacity_ = reader.get_capacity();
    session_ = before.number + 1U;
    next_sequence_ = next;
    next_slot_ = flight::calc_slot(next, capacity_);
    note_place_ = 1U - reader.calc_session_place();
    note_progress();
    return Status::kOk;
}

void FlightRecorder::note_progress() noexcept {
    // Alternate slots: if this write is interrupted, the other slot is intact.
    store(region_, flight::kSessionOffsets[note_place_], flight::encode_session({session_, next_sequence_}));
    order_stores();
    note_place_ = 1U - note_place_;
    noted_until_ = next_sequence_ + capacity_;
}

void FlightRecorder::write(Instant time, Severity severity, std::uint16_t source, std::uint16_t code,
                           std::int64_t argument) noexcept {
    MAMORI_REQUIRE(1, is_open());
    if (next_sequence_ == noted_until_) {
        note_progress();
    }
    const FlightRecord record{next_sequence_, time, argument, session_, source, code, severity};
    const flight::RecordBytes bytes = flight::encode_record(record);
    const std::size_t begin = flight::calc_region_size(next_slot_);
    std::byte& commit = region_[begin + flight::kCommitOffset];
    const std::byte before = commit;
    store(commit, 0U);
    order_stores();
    store(region_, begin, bytes);
    order_stores();
    store(commit, flight::kCommitted);
    overwritten_count_ += before == std::byte{flight::kCommitted} ? 1U : 0U;
    ++next_sequence_;
    next_slot_ = next_slot_ + 1U == capacity_ ? 0U : next_slot_ + 1U;
}

}  // namespace mamori
