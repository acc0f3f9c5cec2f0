// SPDX-License-Identifier: Apache-2.0
// Goal: a region for more records than a header can count is refused before a byte of it is touched, and the
// table of the checksum is the same whoever computes it.
// Method: both sides of the limit; a size alone decides, so that the memory behind it need not exist.
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <unistd.h>

#include <csignal>
#include <limits>

#include "mamori/kernel/base/crc32.hpp"
#include "mamori/kernel/record/flight_reader.hpp"
#include "mamori/kernel/record/flight_recorder.hpp"
#include "mamori/trace/verifies.hpp"

namespace mamori {
namespace {

using namespace verification;

constexpr std::size_t kMostRecords = std::numeric_limits<std::uint32_t>::max();

TEST(FlightLimitsTest, AReaderRefusesMoreRecordsThanAHeaderCanCount) {
    verifies("SWR-REC-005", Technique::kBoundaryValues, Polarity::kViolation);
    const flight::HeaderBytes header = flight::encode_header(std::numeric_limits<std::uint32_t>::max());
    std::array<std::byte, flight::kHeaderSize> bytes{};
    for (std::size_t i = 0U; i < bytes.size(); ++i) {
        bytes[i] = static_cast<std::byte>(header[i]);
    }
    FlightReader sut;

    EXPECT_EQ(sut.open({bytes.data(), flight::calc_region_size(kMostRecords + 1U)}), Status::kBadParameter);
    EXPECT_EQ(sut.get_capacity(), 0U);
    EXPECT_EQ(sut.open({bytes.data(), flight::calc_region_size(kMostRecords)}), Status::kOk)
        << "opening reads the header only";
    EXPECT_EQ(sut.get_capacity(), kMostRecords);
}

TEST(FlightLimitsTest, ARegionForMoreRecordsThanAHeaderCanCountIsNotFormatted) {
    verifies("SWR-REC-007", Technique::kBoundaryValues, Polarity::kViolation);
    std::array<std::byte, 1U> bytes{std::byte{7}};

    EXPECT_EQ(FlightRecorder::format({bytes.data(), flight::calc_region_size(kMostRecords + 1U)}),
              Status::kBadParameter);
    EXPECT_EQ(bytes[0], std::byte{7});
}

TEST(FlightLimitsTest, ARegionForAsManyRecordsAsAHeaderCanCountIsFormatted) {
    verifies("SWR-REC-007", Technique::kBoundaryValues);
    // One page of the region exists, and is shared with the child that dies at its end.
    const auto page = static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
    void* const memory =
        ::mmap(nullptr, 2U * page, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    ASSERT_NE(memory, MAP_FAILED);
    auto* const bytes = static_cast<std::byte*>(memory);
    ASSERT_EQ(::mprotect(bytes + page, page, PROT_NONE), 0);
    bytes[page - 1U] = std::byte{7};
    const auto format = [bytes] {
        static_cast<void>(std::signal(SIGSEGV, SIG_DFL));  // a sanitizer has a handler of its own
        static_cast<void>(FlightRecorder::format({bytes, flight::calc_region_size(kMostRecords)}));
    };

    // Not a failed check: the access to the missing page prints nothing, so the signal and the byte are the
    // evidence.
    EXPECT_EXIT(format(), ::testing::KilledBySignal(SIGSEGV), "^$");
    EXPECT_EQ(bytes[page - 1U], std::byte{0}) << "it was being wiped";
    EXPECT_EQ(::munmap(memory, 2U * page), 0);
}

TEST(FlightLimitsTest, TheChecksumTableComputedWhileRunningIsThatOfTheCompiler) {
    verifies("SWR-REC-001", Technique::kBackToBack);

    EXPECT_EQ(detail::make_crc32_table(), detail::kCrc32Table);
}

}  // namespace
}  // namespace mamori
