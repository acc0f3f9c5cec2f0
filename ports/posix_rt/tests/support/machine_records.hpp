// SPDX-License-Identifier: Apache-2.0
/// @file
/// What a machine wrote to the file of its flight recorder.
#ifndef MAMORI_PORTS_POSIX_RT_TESTS_MACHINE_RECORDS_HPP
#define MAMORI_PORTS_POSIX_RT_TESTS_MACHINE_RECORDS_HPP

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "mamori/kernel/record/flight_reader.hpp"
#include "mamori/ports/posix_rt/crash_note.hpp"
#include "mamori/ports/posix_rt/machine_options.hpp"

namespace mamori::ports::posix_rt {

inline std::vector<std::byte> read_recorder_file(const std::string& path) {
    std::ifstream file{path, std::ios::binary};
    const std::vector<char> bytes{std::istreambuf_iterator<char>{file}, {}};
    const auto* const first = reinterpret_cast<const std::byte*>(bytes.data());
    return {first, first + bytes.size()};
}

/// Records of the machine, without those of the application.
inline std::vector<FlightRecord> read_machine_records(const std::string& path) {
    std::vector<std::byte> bytes = read_recorder_file(path);
    std::vector<FlightRecord> records;
    FlightReader reader;
    const Span<std::byte> region = get_recorder_region({bytes.data(), bytes.size()});
    EXPECT_EQ(reader.open({region.data(), region.size()}), Status::kOk);
    for (std::size_t slot = 0U; slot < reader.get_capacity(); ++slot) {
        FlightRecord record{};
        if (reader.read(slot, record) == SlotState::kWhole && record.source == kMachineSource) {
            records.push_back(record);
        }
    }
    return records;
}

}  // namespace mamori::ports::posix_rt

#endif  // MAMORI_PORTS_POSIX_RT_TESTS_MACHINE_RECORDS_HPP
