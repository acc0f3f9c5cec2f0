// SPDX-License-Identifier: Apache-2.0
// Goal: a span shows exactly the elements it was given and nothing beyond. Method: both sides of each limit.
#include "mamori/kernel/base/span.hpp"

#include <cstdint>
#include <type_traits>

#include "mamori/trace/verifies.hpp"
#include "mamori/verification/failed_check.hpp"

namespace mamori {
namespace {

using namespace verification;

struct Base {
    std::int32_t a;
};
struct Derived : Base {
    std::int32_t b;
};

TEST(SpanTest, ShowsTheElementsOfAnArrayInOrder) {
    verifies("SWR-KRN-002");
    std::array<int, 3> elements{1, 2, 3};
    const Span<int> sut{elements};

    sut[2] = 30;

    EXPECT_EQ(sut.size(), 3U);
    EXPECT_EQ(sut[0], 1);
    EXPECT_EQ(elements[2], 30);
    EXPECT_EQ(sut.end() - sut.begin(), 3);
    int sum = 0;
    for (const int value : sut) {
        sum += value;
    }
    EXPECT_EQ(sum, 33);
}

TEST(SpanTest, OfConstElementsIsMadeFromMutableAndConstArrays) {
    verifies("SWR-KRN-002", Technique::kInterface);
    static constexpr std::array<int, 2> kElements{4, 5};
    std::array<int, 1> mutable_elements{6};
    constexpr Span<const int> kSut{kElements};
    const Span<const int> second{mutable_elements};

    static_assert(kSut[1] == 5, "usable in a constant");
    EXPECT_EQ(second[0], 6);
}

TEST(SpanTest, IsEmptyByDefaultAndOverAnArrayOfNothing) {
    verifies("SWR-KRN-002", Technique::kBoundaryValues);
    std::array<int, 0> nothing{};

    EXPECT_TRUE(Span<int>{}.empty());
    EXPECT_EQ(Span<int>{}.begin(), Span<int>{}.end());
    EXPECT_TRUE(Span<int>{nothing}.empty());
    EXPECT_EQ(Span<int>{nothing}.size(), 0U);
}

TEST(SpanTest, SubspanReachesUpToTheEnd) {
    verifies("SWR-KRN-002", Technique::kBoundaryValues);
    std::array<int, 3> elements{1, 2, 3};
    const Span<int> sut{elements};

    EXPECT_EQ(sut.subspan(1U, 2U)[1], 3);
    EXPECT_TRUE(sut.subspan(3U, 0U).empty());
}

TEST(SpanTest, ADerivedClassDoesNotPassForItsBase) {
    verifies("SWR-KRN-002", Technique::kErrorGuessing, Polarity::kViolation);

    static_assert(!std::is_constructible_v<Span<Base>, std::array<Derived, 2>&>,
                  "elements of another size would be read at wrong places");
    static_assert(!std::is_constructible_v<Span<int>, const std::array<int, 2>&>, "const stays const");
    static_assert(std::is_constructible_v<Span<Base* const>, std::array<Base*, 2>&>);
    SUCCEED();
}

TEST(SpanDeathTest, AnIndexAtTheSizeEndsInTheAssertion) {
    verifies("SWR-KRN-002", Technique::kBoundaryValues, Polarity::kViolation);
    std::array<int, 3> elements{1, 2, 3};
    const Span<int> sut{elements};

    EXPECT_EQ(sut[2], 3);
    EXPECT_CHECK_FAILS(static_cast<void>(sut[3]), "span.hpp", 1);
    EXPECT_CHECK_FAILS(static_cast<void>(Span<int>{}[0]), "span.hpp", 1);
}

TEST(SpanDeathTest, ASubspanBeyondTheEndEndsInTheAssertion) {
    verifies("SWR-KRN-002", Technique::kBoundaryValues, Polarity::kViolation);
    std::array<int, 3> elements{1, 2, 3};
    const Span<int> sut{elements};

    EXPECT_CHECK_FAILS(static_cast<void>(sut.subspan(4U, 0U)), "span.hpp", 2);
    EXPECT_CHECK_FAILS(static_cast<void>(sut.subspan(1U, 3U)), "span.hpp", 2);
    EXPECT_CHECK_FAILS(static_cast<void>(sut.subspan(1U, SIZE_MAX)), "span.hpp", 2);
}

}  // namespace
}  // namespace mamori
