// SPDX-License-Identifier: Apache-2.0
#include "mamori/kernel/flight_recorder.hpp"

#include <atomic>
#include <limits>

#include "mamori/kernel/flight_reader.hpp"

namespace mamori {
namespace {

/// Each store happens, and in this order: whoever looks at the memory after the program's end has to rely on
/// it.
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

/// Stores before it reach the memory before those after it, on machines that would rather not.
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

/// Newest session and newest record that can be read, wherever they are told of.
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

/// Number for the next record: behind every one that can be read and behind the slots after it that cannot,
/// since their numbers may have been given. @param[in] first_of_session 0: no session is known.
std::uint64_t find_next_sequence(const FlightReader& reader, std::uint64_t first_of_session) noexcept {
    const std::uint64_t newest = reader.calc_newest_sequence();
    std::uint64_t next = newest < first_of_session ? first_of_session : newest + 1U;
    FlightRecord record{};
    for (std::size_t i = 0U; i < reader.get_capacity(); ++i) {
        const SlotState state = reader.read(flight::calc_slot(next, reader.get_capacity()), record);
        if (state != SlotState::kTorn && state != SlotState::kCorrupt) {
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
    // The beginning goes first and comes last: a region that was left half-way is taken for no recorder.
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
    if (is_blank(bytes)) {
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
    const std::uint64_t next = find_next_sequence(reader, before.first_sequence);
    if (next > flight::kSequenceMax || before.number == std::numeric_limits<std::uint32_t>::max()) {
        return Status::kOutOfResources;
    }
    const FlightSession session{before.number + 1U, next};
    // Two places take turns, so one of them is whole whenever this ends.
    store(region, flight::kSessionOffsets[session.number % 2U], flight::encode_session(session));
    region_ = region;
    capacity_ = reader.get_capacity();
    session_ = session.number;
    next_sequence_ = next;
    next_slot_ = flight::calc_slot(next, capacity_);
    return Status::kOk;
}

void FlightRecorder::write(Instant time, Severity severity, std::uint16_t source, std::uint16_t code,
                           std::int64_t argument) noexcept {
    MAMORI_REQUIRE(1, is_open());
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
