// SPDX-License-Identifier: Apache-2.0
// Goal: a sequence holds up to its bound and refuses more without a change.
// Method: both sides of the bound for each operation that makes it longer; comparison; constant expressions.
#include "mamori/kernel/payload/bounded_sequence.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "mamori/trace/verifies.hpp"
#include "mamori/verification/failed_check.hpp"

namespace mamori {
namespace {

using namespace verification;

using Three = BoundedSequence<int, 3>;
static_assert(std::is_trivially_copyable_v<Three>);
static_assert(Three::capacity() == 3U && Three(std::array{4, 5})[1] == 5);

std::vector<int> list(const Three& sequence) {
    return {sequence.begin(), sequence.end()};
}

TEST(BoundedSequenceTest, ElementsComeBackInOrder) {
    verifies("SWR-CDR-002");
    Three sut;

    EXPECT_TRUE(sut.empty());
    EXPECT_EQ(sut.push_back(1), Status::kOk);
    EXPECT_EQ(sut.push_back(2), Status::kOk);
    sut[0] = 7;
    EXPECT_FALSE(sut.empty());
    EXPECT_EQ(list(sut), (std::vector<int>{7, 2}));
    sut.clear();
    EXPECT_EQ(list(sut), std::vector<int>{});
}

TEST(BoundedSequenceTest, AFullSequenceTakesNoMore) {
    verifies("SWR-CDR-002", Technique::kBoundaryValues, Polarity::kViolation);
    Three sut = std::array{1, 2};

    EXPECT_EQ(sut.push_back(3), Status::kOk);
    EXPECT_EQ(sut.push_back(4), Status::kOutOfResources);
    EXPECT_EQ(sut.resize(4U), Status::kOutOfResources);
    EXPECT_EQ(sut.assign(Span<const int>(std::array{5, 6, 7, 8})), Status::kOutOfResources);
    EXPECT_EQ(list(sut), (std::vector<int>{1, 2, 3}));
    EXPECT_EQ(sut.assign(Span<const int>(std::array{5, 6, 7})), Status::kOk);
    EXPECT_EQ(list(sut), (std::vector<int>{5, 6, 7}));
}

TEST(BoundedSequenceTest, WhatComesInByResizeIsZero) {
    verifies("SWR-CDR-002", Technique::kErrorGuessing);
    Three sut = std::array{1, 2, 3};

    EXPECT_EQ(sut.resize(1U), Status::kOk);
    EXPECT_EQ(sut.resize(3U), Status::kOk);
    EXPECT_EQ(list(sut), (std::vector<int>{1, 0, 0}));
    EXPECT_EQ(sut.resize(0U), Status::kOk);
    EXPECT_TRUE(sut.empty());
}

TEST(BoundedSequenceTest, APartOfItselfCanBeAssigned) {
    verifies("SWR-CDR-002", Technique::kErrorGuessing);
    Three sut = std::array{1, 2, 3};

    EXPECT_EQ(sut.assign(Span<const int>(sut.data() + 1, 2U)), Status::kOk);
    EXPECT_EQ(list(sut), (std::vector<int>{2, 3}));
}

TEST(BoundedSequenceTest, OnlyElementsInUseAreCompared) {
    verifies("SWR-CDR-004", Technique::kErrorGuessing);
    Three shrunk = std::array{1, 2, 3};
    ASSERT_EQ(shrunk.resize(2U), Status::kOk);

    EXPECT_TRUE(shrunk == Three(std::array{1, 2}));
    EXPECT_TRUE(shrunk != Three(std::array{1, 3}));
    EXPECT_TRUE(shrunk != Three(std::array{1}));
    EXPECT_TRUE(shrunk != Three(std::array{1, 2, 3}));
}

TEST(BoundedSequenceDeathTest, AnElementThatIsNotInUseIsOutOfReach) {
    verifies("SWR-CDR-002", Technique::kBoundaryValues, Polarity::kViolation);
    Three sut = std::array{1, 2};
    const Three& constant = sut;

    EXPECT_EQ(sut[1], 2);
    EXPECT_CHECK_FAILS(sut[2] = 1, "bounded_sequence.hpp", 1);
    EXPECT_CHECK_FAILS(static_cast<void>(constant[2]), "bounded_sequence.hpp", 2);
}

}  // namespace
}  // namespace mamori
