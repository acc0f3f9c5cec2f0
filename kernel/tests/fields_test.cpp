// SPDX-License-Identifier: Apache-2.0
// Goal: a field list leads to every scalar of a payload once, in declaration order.
// Method: nested payloads, arrays, enums and bounds of the list's length are visited and written down.
#include "mamori/kernel/payload/fields.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

#include "mamori/trace/verifies.hpp"

namespace mamori {
namespace {

enum class Mode : std::uint8_t { kIdle = 4 };

struct Inner {
    std::int8_t small;
    double large;
};
struct Outer {
    bool flag;
    std::array<Inner, 2> inner;
    Mode mode;
    std::array<std::uint16_t, 0> nothing;
};
struct Forty {
    std::int32_t a0, a1, a2, a3, a4, a5, a6, a7, a8, a9;
    std::int32_t b0, b1, b2, b3, b4, b5, b6, b7, b8, b9;
    std::int32_t c0, c1, c2, c3, c4, c5, c6, c7, c8, c9;
    std::int32_t d0, d1, d2, d3, d4, d5, d6, d7, d8, d9;
};
/// Names that the macro could use itself.
struct Awkward {
    std::int32_t value, call, self, field;
};
struct Bounded {
    BoundedSequence<Inner, 3> inner;
    BoundedString<4> name;
    BoundedSequence<BoundedString<2>, 2> names;
    std::uint8_t last;
};
struct One {
    std::int32_t only;
};
struct Bare {
    std::int32_t value;
};
struct NotCopyable {
    NotCopyable() = default;
    NotCopyable(const NotCopyable& other) : value(other.value) {}
    std::int32_t value{0};
};

}  // namespace
}  // namespace mamori
MAMORI_FIELDS(mamori::Inner, small, large)
MAMORI_FIELDS(mamori::Outer, flag, inner, mode, nothing)
MAMORI_FIELDS(mamori::Forty, a0, a1, a2, a3, a4, a5, a6, a7, a8, a9, b0, b1, b2, b3, b4, b5, b6, b7, b8, b9,
              c0, c1, c2, c3, c4, c5, c6, c7, c8, c9, d0, d1, d2, d3, d4, d5, d6, d7, d8, d9)
MAMORI_FIELDS(mamori::Awkward, value, call, self, field)
MAMORI_FIELDS(mamori::Bounded, inner, name, names, last)
MAMORI_FIELDS(mamori::One, only)
MAMORI_FIELDS(mamori::NotCopyable, value)

namespace mamori {
namespace {

using namespace verification;

/// Writes every scalar down.
struct Notes {
    std::vector<double> values;
    template <typename T>
    void operator()(T scalar) noexcept {
        values.push_back(static_cast<double>(scalar));
    }
};

TEST(FieldsTest, NestedPayloadsAreVisitedInDeclarationOrder) {
    verifies("SWR-KRN-005");
    Outer payload{};
    payload.flag = true;
    payload.inner = {{{-3, 2.5}, {7, -0.5}}};
    payload.mode = Mode::kIdle;
    Notes notes;

    visit_scalars(payload, notes);

    EXPECT_EQ(notes.values, (std::vector<double>{1.0, -3.0, 2.5, 7.0, -0.5, 4.0}));
}

TEST(FieldsTest, AListHoldsOneFieldOrFortyWhateverTheyAreCalled) {
    verifies("SWR-CDR-001", Technique::kBoundaryValues);
    Forty forty{};
    std::vector<double> expected;
    std::int32_t next = 0;
    const auto number = [&](auto&... field) noexcept { ((field = next++), ...); };
    Notes of_forty;
    Notes of_one;
    Notes of_awkward;

    Fields<Forty>::apply(forty, number);
    visit_scalars(forty, of_forty);
    visit_scalars(One{5}, of_one);
    visit_scalars(Awkward{1, 2, 3, 4}, of_awkward);

    for (int i = 0; i < 40; ++i) {
        expected.push_back(i);
    }
    EXPECT_EQ(forty.d9, 39);
    EXPECT_EQ(of_forty.values, expected);
    EXPECT_EQ(of_one.values, std::vector<double>{5});
    EXPECT_EQ(of_awkward.values, (std::vector<double>{1, 2, 3, 4}));
}

TEST(FieldsTest, ASequenceIsItsLengthAndTheElementsInUse) {
    verifies("SWR-CDR-004");
    Bounded payload{};
    payload.inner = std::array<Inner, 2>{{{1, 2.0}, {3, 4.0}}};
    payload.name = "ab";
    payload.names = std::array<BoundedString<2>, 1>{"c"};
    payload.last = 9U;
    Notes notes;
    Notes of_nothing;

    visit_scalars(payload, notes);
    visit_scalars(Bounded{}, of_nothing);

    EXPECT_EQ(notes.values, (std::vector<double>{2, 1, 2, 3, 4, 2, 97, 98, 1, 1, 99, 9}));
    EXPECT_EQ(of_nothing.values, (std::vector<double>{0, 0, 0, 0}));
}

TEST(FieldsTest, NumbersAndArraysOfPayloadsNeedNoListOfTheirOwn) {
    verifies("SWR-KRN-005", Technique::kEquivalenceClasses);

    static_assert(is_payload<double>() && is_payload<bool>() && is_payload<Mode>());
    static_assert(is_payload<Inner>() && is_payload<std::array<Inner, 3>>());
    static_assert(is_payload<std::array<std::array<float, 2>, 0>>());
    static_assert(is_payload<BoundedSequence<Inner, 3>>() && is_payload<BoundedString<1>>());
    EXPECT_TRUE(is_payload<Inner>()) << "while running too";
}

TEST(FieldsTest, WhatHasNoListOrCannotBeCopiedAsBytesIsNoPayload) {
    verifies("SWR-KRN-005", Technique::kEquivalenceClasses, Polarity::kViolation);

    static_assert(!is_payload<Bare>() && !is_payload<std::array<Bare, 2>>());
    static_assert(!is_payload<NotCopyable>(), "a list alone is not enough");
    static_assert(!is_payload<BoundedSequence<Bare, 2>>(), "a sequence is what its elements are");
    static_assert(!is_payload<double*>() && !is_payload<std::string>());
    EXPECT_FALSE(is_payload<Bare>()) << "while running too";
}

}  // namespace
}  // namespace mamori
