// SPDX-License-Identifier: Apache-2.0
// Any bytes as the region of a flight recorder. The reader stays within the region. A rejected region stays
// unchanged, and an accepted one takes new records without changing the others. The first input byte selects
// the parts that are corrected first, because a fuzzer cannot guess checksums: bit 0 the header, bit 1 the
// records.
#include <cstdint>
#include <cstdlib>
#include <vector>

#include "mamori/kernel/base/crc32.hpp"
#include "mamori/kernel/record/flight_reader.hpp"
#include "mamori/kernel/record/flight_recorder.hpp"

namespace {

namespace flight = mamori::flight;
using mamori::FlightReader;
using mamori::FlightRecord;
using mamori::FlightRecorder;
using mamori::SlotState;
using mamori::Status;
using Bytes = std::vector<std::byte>;

void demand(bool condition) {
    if (!condition) {
        std::abort();
    }
}

mamori::Span<const std::byte> view(const Bytes& bytes) {
    return {bytes.data(), bytes.size()};
}

void mend_header(Bytes& region) {
    const flight::HeaderBytes header =
        flight::encode_header(static_cast<std::uint32_t>(flight::calc_capacity(region.size())));
    for (std::size_t i = 0U; i < flight::kSessionOffsets[0]; ++i) {
        region[i] = std::byte{header[i]};
    }
}

/// Sets the commit byte and the checksum of each used slot to match its bytes.
void mend_records(Bytes& region) {
    for (std::size_t slot = 0U; slot < flight::calc_capacity(region.size()); ++slot) {
        std::byte* const record = region.data() + flight::calc_region_size(slot);
        if (record[flight::kCommitOffset] == std::byte{0U}) {
            continue;
        }
        mamori::Crc32 crc;
        for (std::size_t i = 0U; i < flight::kCommitOffset; ++i) {
            crc.add(std::to_integer<std::uint8_t>(record[i]));
        }
        record[flight::kCommitOffset] = std::byte{flight::kCommitted};
        for (std::size_t i = 0U; i < 4U; ++i) {
            record[flight::kCommitOffset + 1U + i] =
                static_cast<std::byte>((crc.get_value() >> (8U * i)) & 0xFFU);
        }
    }
}

std::vector<std::uint64_t> read_sequences(const FlightReader& reader) {
    std::vector<std::uint64_t> sequences;
    for (std::size_t slot = 0U; slot < reader.get_capacity(); ++slot) {
        FlightRecord record{};
        const bool is_whole = reader.read(slot, record) == SlotState::kWhole;
        demand(!is_whole || flight::calc_slot(record.sequence, reader.get_capacity()) == slot);
        sequences.push_back(is_whole ? record.sequence : 0U);
    }
    return sequences;
}

void check_writing(Bytes region) {
    const Bytes before = region;
    FlightRecorder recorder;
    if (recorder.open({region.data(), region.size()}) != Status::kOk) {
        demand(region == before && !recorder.is_open());
        return;
    }
    FlightReader reader;
    demand(reader.open(view(region)) == Status::kOk);
    const std::size_t capacity = reader.get_capacity();
    const std::uint64_t first = recorder.get_next_sequence();
    std::vector<std::uint64_t> wanted = read_sequences(reader);
    demand(reader.calc_newest_sequence() < first && recorder.get_session() > 0U);
    demand(reader.calc_session().number == recorder.get_session());
    for (std::uint64_t i = 0U; i < capacity + 1U && first + i <= flight::kSequenceMax; ++i) {
        recorder.write(mamori::Instant{-1}, mamori::Severity::kFault, 1U, 2U, 3);
        wanted[flight::calc_slot(first + i, capacity)] = first + i;
        demand(read_sequences(reader) == wanted);
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size == 0U) {
        return 0;
    }
    Bytes region;
    for (std::size_t i = 1U; i < size; ++i) {
        region.push_back(std::byte{data[i]});
    }
    if ((data[0] & 1U) != 0U && flight::calc_capacity(region.size()) > 0U) {
        mend_header(region);
    }
    if ((data[0] & 2U) != 0U) {
        mend_records(region);
    }
    FlightReader reader;
    if (reader.open(view(region)) == Status::kOk) {
        static_cast<void>(read_sequences(reader));
        static_cast<void>(reader.calc_newest_sequence());
        static_cast<void>(reader.calc_session());
    } else {
        demand(reader.get_capacity() == 0U);
    }
    check_writing(region);
    return 0;
}
