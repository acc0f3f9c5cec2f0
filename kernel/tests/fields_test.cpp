// SPDX-License-Identifier: Apache-2.0
// Goal: a field list leads to every scalar of a payload once, in declaration order.
// Method: nested payloads, arrays, enums and bounds of the list's length are visited and written down.
#include "mamori/kernel/fields.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

#include "mamori/verification/verifies.hpp"

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
struct Ten {
    std::int32_t a, b, c, d, e, f, g, h, i, j;
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
MAMORI_FIELDS(mamori::Ten, a, b, c, d, e, f, g, h, i, j)
MAMORI_FIELDS(mamori::One, only)
MAMORI_FIELDS(mamori::NotCopyable, value)

namespace mamori {
namespace {

using verification::Polarity;
using verification::Technique;
using verification::verifies;

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

TEST(FieldsTest, AListHoldsOneToTenFields) {
    verifies("SWR-KRN-005", Technique::kBoundaryValues);
    Notes of_ten;
    Notes of_one;

    visit_scalars(Ten{1, 2, 3, 4, 5, 6, 7, 8, 9, 10}, of_ten);
    visit_scalars(One{5}, of_one);

    EXPECT_EQ(of_ten.values, (std::vector<double>{1, 2, 3, 4, 5, 6, 7, 8, 9, 10}));
    EXPECT_EQ(of_one.values, std::vector<double>{5});
}

TEST(FieldsTest, NumbersAndArraysOfPayloadsNeedNoListOfTheirOwn) {
    verifies("SWR-KRN-005", Technique::kEquivalenceClasses);

    static_assert(is_payload<double>() && is_payload<bool>() && is_payload<Mode>());
    static_assert(is_payload<Inner>() && is_payload<std::array<Inner, 3>>());
    static_assert(is_payload<std::array<std::array<float, 2>, 0>>());
    SUCCEED();
}

TEST(FieldsTest, WhatHasNoListOrCannotBeCopiedAsBytesIsNoPayload) {
    verifies("SWR-KRN-005", Technique::kEquivalenceClasses, Polarity::kViolation);

    static_assert(!is_payload<Bare>() && !is_payload<std::array<Bare, 2>>());
    static_assert(!is_payload<NotCopyable>(), "a list alone is not enough");
    static_assert(!is_payload<double*>() && !is_payload<std::string>());
    SUCCEED();
}

}  // namespace
}  // namespace mamori
