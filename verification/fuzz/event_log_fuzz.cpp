// SPDX-License-Identifier: Apache-2.0
/// @file
/// Drives an event log with any capacity from 0 to 8 through any sequence of writes. After each write,
/// compares the log with its requirement: the newest records in order, all other records counted as lost.
///
/// Input: byte 0 chooses the capacity, each further byte is one write. Requirement: SWR-KRN-019.
#include <array>
#include <cstddef>
#include <cstdint>

#include "mamori/kernel/record/event_log.hpp"

namespace {

constexpr std::size_t kCapacityMax = 8U;

void require(bool holds) {
    if (!holds) {
        __builtin_trap();
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size == 0U) {
        return 0;
    }
    std::array<mamori::Event, kCapacityMax> storage{};
    const std::size_t capacity = data[0] % (kCapacityMax + 1U);
    mamori::EventLog log{mamori::Span<mamori::Event>{storage.data(), capacity}};
    for (std::size_t written = 1U; written < size; ++written) {
        const std::uint8_t value = data[written];
        log.write(mamori::Instant{value}, mamori::Severity::kWarning, value, value, -std::int64_t{value});
        const std::size_t kept = written < capacity ? written : capacity;
        require(log.size() == kept);
        require(log.get_lost_count() == written - kept);
        for (std::size_t i = 0U; i < kept; ++i) {
            const std::size_t sequence = written - kept + i;
            const std::uint8_t wanted = data[sequence + 1U];
            const mamori::Event& event = log.get(i);
            require(event.sequence == sequence);
            require(event.time == mamori::Instant{wanted});
            require(event.severity == mamori::Severity::kWarning);
            require(event.source == wanted && event.code == wanted);
            require(event.argument == -std::int64_t{wanted});
        }
    }
    return 0;
}
