// SPDX-License-Identifier: Apache-2.0
// Goal: the operands of the processor check are the ones that it needs: every pair of bits, the edges of each
// format. Method: the tables of both widths beside one list, which says in words of the format what the
// operands are; the results are judged by the processor in cpu_check_test.cpp.
#include "mamori/safety/self_test/cpu_patterns.hpp"

#include <array>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "mamori/trace/verifies.hpp"

namespace mamori::safety {
namespace {

using namespace verification;
using Do = ArithmeticOperation;

template <typename T>
struct Operands {
    Do operation;
    T a;
    T b;
};

template <typename T, typename Cases>
void expect_operands(const Cases& cases, const std::vector<Operands<T>>& expected) {
    ASSERT_EQ(cases.size(), expected.size());
    for (std::size_t i = 0U; i < cases.size(); ++i) {
        using Bits = decltype(cases[i].a);
        EXPECT_EQ(cases[i].operation, expected[i].operation) << i;
        EXPECT_EQ(cases[i].a, __builtin_bit_cast(Bits, expected[i].a)) << i;
        EXPECT_EQ(cases[i].b, __builtin_bit_cast(Bits, expected[i].b)) << i;
    }
}

/// Each bit of a result must have come from each of the four pairs of operand bits.
template <typename Word, typename Cases>
void expect_every_pair_of_bits(const Cases& cases, WordOperation operation) {
    std::array<Word, 4U> bits_with_pair{};
    for (const auto& one : cases) {
        if (one.operation == operation) {
            bits_with_pair[0] |= static_cast<Word>(~one.a & ~one.b);
            bits_with_pair[1] |= static_cast<Word>(~one.a & one.b);
            bits_with_pair[2] |= static_cast<Word>(one.a & ~one.b);
            bits_with_pair[3] |= static_cast<Word>(one.a & one.b);
        }
    }
    for (const Word bits : bits_with_pair) {
        EXPECT_EQ(bits, std::numeric_limits<Word>::max()) << static_cast<int>(operation);
    }
}

template <typename Word>
constexpr Word kAll = std::numeric_limits<Word>::max();
template <typename Word>
constexpr Word kOddBits = kAll<Word> / 3U;  ///< 0101...01
template <typename Word>
constexpr Word kEvenBits = kAll<Word> - kOddBits<Word>;

/// Divisions and remainders: alternating bits, equal operands, a divisor that is one too large, half the
/// bits.
template <typename Word, typename Arithmetic, typename Words>
void expect_edges_of_division(const Arithmetic& arithmetic, const Words& words) {
    constexpr int kBits = std::numeric_limits<Word>::digits;
    const std::vector<std::pair<Word, Word>> divisions{
        {kAll<Word>, 3U}, {kEvenBits<Word>, 1U}, {kAll<Word>, kAll<Word>}, {kAll<Word> - 1U, kAll<Word>}};
    for (std::size_t i = 0U; i < divisions.size(); ++i) {
        EXPECT_EQ(arithmetic[18U + i].operation, Do::kDivide);
        EXPECT_EQ(arithmetic[18U + i].a, divisions[i].first) << i;
        EXPECT_EQ(arithmetic[18U + i].b, divisions[i].second) << i;
    }
    EXPECT_EQ(arithmetic[23].a, Word{1U} << (kBits - 1)) << "half of the bits, exactly";
    EXPECT_EQ(arithmetic[23].b, Word{1U} << (kBits / 2));
    const std::array<Word, 3U> remainders{kOddBits<Word>, kEvenBits<Word>, kAll<Word>};
    for (std::size_t i = 0U; i < remainders.size(); ++i) {
        EXPECT_EQ(words[i].operation, WordOperation::kRemainder);
        EXPECT_EQ(words[i].a, remainders[i]) << i;
        EXPECT_EQ(words[i].b, kAll<Word>) << i;
    }
}

/// Small whole numbers, numbers that no format holds, alternating bits, and where the step of the format
/// is 1.
template <typename T, typename Bits>
std::vector<Operands<T>> make_arithmetic() {
    constexpr T kStep = std::numeric_limits<T>::epsilon();
    const T odd = __builtin_bit_cast(T, kOddBits<Bits>);
    const T even = __builtin_bit_cast(T, kEvenBits<Bits>);
    const T tenth = T{1} / T{10};
    return {{Do::kAdd, 1, 2},
            {Do::kAdd, odd, 0},
            {Do::kAdd, even, 0},
            {Do::kAdd, tenth, 2 * tenth},
            {Do::kAdd, 2 / kStep, -1},
            {Do::kSubtract, 3, 2},
            {Do::kSubtract, odd, 0},
            {Do::kSubtract, even, 0},
            {Do::kSubtract, 1 + kStep, 1},
            {Do::kSubtract, tenth, 3},
            {Do::kMultiply, odd, 1},
            {Do::kMultiply, even, 1},
            {Do::kMultiply, tenth, tenth},
            {Do::kMultiply, 3, -1},
            {Do::kMultiply, 1 + kStep, 1 + kStep},
            {Do::kDivide, odd, 1},
            {Do::kDivide, even, 1},
            {Do::kDivide, 1, 3},
            {Do::kDivide, 2, 3},
            {Do::kDivide, -1, 10}};
}

/// Ties to both neighbours and what lies beyond a tie; the smallest and the largest numbers; infinity and
/// zero.
template <typename T>
std::vector<Operands<T>> make_mode() {
    using Limits = std::numeric_limits<T>;
    constexpr T kStep = Limits::epsilon();
    constexpr T kHalf = kStep / 2;
    constexpr T kMore = kStep / 4 * 3;
    return {{Do::kAdd, 1, kHalf},
            {Do::kAdd, 1 + kStep, kHalf},
            {Do::kAdd, 1, kMore},
            {Do::kSubtract, -1, kHalf},
            {Do::kSubtract, -1, kMore},
            {Do::kMultiply, Limits::min(), T(0.5)},
            {Do::kMultiply, -Limits::min(), T(0.5)},
            {Do::kAdd, Limits::denorm_min(), Limits::denorm_min()},
            {Do::kSubtract, Limits::min(), Limits::denorm_min()},
            {Do::kDivide, Limits::min(), 2},
            {Do::kMultiply, Limits::max(), 2},
            {Do::kAdd, Limits::infinity(), 1},
            {Do::kDivide, 1, 0},
            {Do::kDivide, -1, 0},
            {Do::kDivide, 1, Limits::infinity()},
            {Do::kSubtract, -Limits::infinity(), Limits::max()}};
}

TEST(CpuPatternsTest, EveryBitOfALogicOperationMeetsEveryPairOfBits) {
    verifies("SWR-SLF-008", Technique::kEquivalenceClasses);

    for (const WordOperation operation :
         {WordOperation::kAnd, WordOperation::kOr, WordOperation::kExclusiveOr}) {
        expect_every_pair_of_bits<std::uint32_t>(detail::kWords32, operation);
        expect_every_pair_of_bits<std::uint64_t>(detail::kWords64, operation);
    }
}

TEST(CpuPatternsTest, DivisionsHaveTheEdgesOfTheirWords) {
    verifies("SWR-SLF-008", Technique::kBoundaryValues);

    expect_edges_of_division<std::uint32_t>(detail::kArithmetic32, detail::kWords32);
    expect_edges_of_division<std::uint64_t>(detail::kArithmetic64, detail::kWords64);
}

TEST(CpuPatternsTest, FloatingPointOperandsAreThoseOfTheirFormat) {
    verifies("SWR-SLF-008", Technique::kBoundaryValues);

    expect_operands<float>(detail::kFloatArithmetic, make_arithmetic<float, std::uint32_t>());
    expect_operands<double>(detail::kDoubleArithmetic, make_arithmetic<double, std::uint64_t>());
    expect_operands<float>(detail::kFloatMode, make_mode<float>());
    expect_operands<double>(detail::kDoubleMode, make_mode<double>());
}

}  // namespace
}  // namespace mamori::safety
