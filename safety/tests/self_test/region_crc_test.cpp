// SPDX-License-Identifier: Apache-2.0
// Goal: a region that is not what was built is found, however it is cut into steps.
// Method: the published check value of CRC-32; every single-bit error of a table, every burst up to its
// width.
#include "mamori/safety/self_test/region_crc.hpp"

#include <array>
#include <cstring>

#include "mamori/trace/verifies.hpp"
#include "mamori/verification/failed_check.hpp"

namespace mamori::safety {
namespace {

using namespace verification;

SelfTestStatus run_pass(SelfTest& test) {
    test.begin();
    SelfTestStatus status = SelfTestStatus::kRunning;
    for (std::size_t i = 0U; i < test.get_step_count() && status == SelfTestStatus::kRunning; ++i) {
        status = test.step();
    }
    return status;
}

class RegionCrcTest : public ::testing::Test {
  protected:
    static constexpr std::size_t kSize = 40U;

    RegionCrcTest() {
        for (std::size_t i = 0U; i < kSize; ++i) {
            region_[i] = static_cast<std::byte>(i * 37U);
        }
        Crc<kCrc32> crc;
        crc.add(view());
        expected_ = crc.get_value();
    }
    Span<const std::byte> view() const { return {region_.data(), kSize}; }
    void flip(std::size_t bit) { region_[bit / 8U] ^= static_cast<std::byte>(1U << (bit % 8U)); }

    std::array<std::byte, kSize> region_{};
    std::uint32_t expected_{0U};
};

TEST_F(RegionCrcTest, PublishedCheckValueIsMet) {
    verifies("SWR-SLF-007");
    std::memcpy(region_.data(), "123456789", 9U);
    RegionCrc sut({region_.data(), 9U}, 0xCBF43926U, 4U);

    EXPECT_EQ(sut.get_step_count(), 3U);
    EXPECT_EQ(run_pass(sut), SelfTestStatus::kPassed);
    EXPECT_EQ(run_pass(sut), SelfTestStatus::kPassed);
}

TEST_F(RegionCrcTest, EveryCutIntoStepsGivesTheSame) {
    verifies("SWR-SLF-007", Technique::kBoundaryValues);

    for (std::size_t per_step = 1U; per_step <= kSize + 1U; ++per_step) {
        RegionCrc sut(view(), expected_, per_step);
        sut.begin();
        for (std::size_t step = 1U; step < sut.get_step_count(); ++step) {
            ASSERT_EQ(sut.step(), SelfTestStatus::kRunning) << per_step;
        }
        ASSERT_EQ(sut.step(), SelfTestStatus::kPassed) << per_step;
    }
}

TEST_F(RegionCrcTest, EveryTurnedBitIsFound) {
    verifies("SWR-SLF-007", Technique::kFaultInjection, Polarity::kViolation);
    RegionCrc sut(view(), expected_, 7U);

    for (std::size_t bit = 0U; bit < kSize * 8U; ++bit) {
        flip(bit);
        ASSERT_EQ(run_pass(sut), SelfTestStatus::kFailed) << bit;
        flip(bit);
    }
    EXPECT_EQ(run_pass(sut), SelfTestStatus::kPassed);
}

TEST_F(RegionCrcTest, EveryBurstUpToTheWidthIsFound) {
    verifies("SWR-SLF-007", Technique::kFaultInjection, Polarity::kViolation);
    RegionCrc sut(view(), expected_, kSize);

    for (std::size_t length = 2U; length <= 32U; ++length) {
        for (std::size_t bit = 0U; bit + length <= kSize * 8U; ++bit) {
            flip(bit);
            flip(bit + length - 1U);
            ASSERT_EQ(run_pass(sut), SelfTestStatus::kFailed) << bit << ' ' << length;
            flip(bit);
            flip(bit + length - 1U);
        }
    }
}

TEST_F(RegionCrcTest, WrongExpectationIsFound) {
    verifies("SWR-SLF-007", Technique::kErrorGuessing, Polarity::kViolation);
    RegionCrc sut(view(), expected_ ^ 1U, 7U);

    EXPECT_EQ(run_pass(sut), SelfTestStatus::kFailed);
}

TEST_F(RegionCrcTest, TheFirstPassMakesTheReference) {
    verifies("SWR-CYC-024");
    flip(3U);
    RegionCrc sut(region_, 7U);

    EXPECT_EQ(sut.get_step_count(), (kSize + 6U) / 7U);
    EXPECT_EQ(run_pass(sut), SelfTestStatus::kPassed) << "what is wrong before is not found";
    EXPECT_EQ(run_pass(sut), SelfTestStatus::kPassed);
}

TEST_F(RegionCrcTest, EachBitThatTurnsAfterTheFirstPassIsFound) {
    verifies("SWR-CYC-024", Technique::kFaultInjection, Polarity::kViolation);
    RegionCrc sut(region_, 7U);
    ASSERT_EQ(run_pass(sut), SelfTestStatus::kPassed);

    for (std::size_t bit = 0U; bit < kSize * 8U; ++bit) {
        flip(bit);
        ASSERT_EQ(run_pass(sut), SelfTestStatus::kFailed) << bit;
        flip(bit);
    }
    EXPECT_EQ(run_pass(sut), SelfTestStatus::kPassed) << "a failure does not change the reference";
    EXPECT_CHECK_FAILS((RegionCrc{region_, 0U}), "region_crc.hpp", 2);
}

TEST_F(RegionCrcTest, NothingToCheckGoesToTheAssertionHandler) {
    verifies("SWR-SLF-007", Technique::kBoundaryValues, Polarity::kViolation);

    EXPECT_CHECK_FAILS((RegionCrc{Span<const std::byte>{}, 0U, 1U}), "region_crc.hpp", 1);
    EXPECT_CHECK_FAILS((RegionCrc{view(), 0U, 0U}), "region_crc.hpp", 1);
}

}  // namespace
}  // namespace mamori::safety
