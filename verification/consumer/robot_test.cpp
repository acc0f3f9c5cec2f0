// SPDX-License-Identifier: Apache-2.0
// A test of a user. Goal: it links with the undefined-behaviour sanitizer against target layers, which have
// no type information, and it names the requirement that it verifies.
#include <array>
#include <cstddef>

#include "mamori/safety/self_test/region_crc.hpp"
#include "mamori/verification/verifies.hpp"

namespace {

using mamori::verification::Polarity;
using mamori::verification::Technique;
using mamori::verification::verifies;

TEST(RobotTest, RegionWithThePublishedCheckValuePasses) {
    verifies("SWR-APP-001", Technique::kInterface, Polarity::kNominal);
    std::array<std::byte, 9U> region{};
    for (std::size_t i = 0U; i < region.size(); ++i) {
        region[i] = static_cast<std::byte>('1' + static_cast<int>(i));
    }
    mamori::safety::RegionCrc check({region.data(), region.size()}, 0xCBF43926U, region.size());

    check.begin();
    EXPECT_EQ(check.step(), mamori::safety::SelfTestStatus::kPassed);
}

}  // namespace
