// SPDX-License-Identifier: Apache-2.0
/// @file
/// Operands and exact results for the CPU check, all as bits. Per operation the results hold each bit as 0
/// and as 1, so a bit of the result that is stuck is found; the tests show it for every one.
///
/// @satisfies SWR-SLF-008, SWR-SLF-009      Design: docs/design/self_tests.md#processor
/// Source:   results follow from the definition of unsigned arithmetic and of IEEE 754 (to nearest, ties to
/// even)
#ifndef MAMORI_SAFETY_SELF_TEST_CPU_PATTERNS_HPP
#define MAMORI_SAFETY_SELF_TEST_CPU_PATTERNS_HPP

#include <array>
#include <cstdint>
#include <limits>

#include "mamori/safety/self_test/native_cpu.hpp"

namespace mamori::safety::detail {

/// One operation with its exact result.
template <typename Operation, typename Bits>
struct CpuCase {
    Operation operation;
    Bits a;
    Bits b;
    Bits result;
};

inline constexpr std::array<CpuCase<ArithmeticOperation, std::uint32_t>, 24U> kArithmetic32{{
    {ArithmeticOperation::kAdd, 0xFFFFFFFFU, 0x00000001U, 0x00000000U},
    {ArithmeticOperation::kAdd, 0x55555555U, 0xAAAAAAAAU, 0xFFFFFFFFU},
    {ArithmeticOperation::kAdd, 0xAAAAAAAAU, 0xAAAAAAAAU, 0x55555554U},
    {ArithmeticOperation::kAdd, 0x55555555U, 0x55555555U, 0xAAAAAAAAU},
    {ArithmeticOperation::kAdd, 0x80000000U, 0x80000000U, 0x00000000U},
    {ArithmeticOperation::kAdd, 0x89ABCDEFU, 0x7F4A7C15U, 0x08F64A04U},
    {ArithmeticOperation::kSubtract, 0x00000000U, 0x00000001U, 0xFFFFFFFFU},
    {ArithmeticOperation::kSubtract, 0x55555555U, 0xAAAAAAAAU, 0xAAAAAAABU},
    {ArithmeticOperation::kSubtract, 0xAAAAAAAAU, 0x55555555U, 0x55555555U},
    {ArithmeticOperation::kSubtract, 0x80000000U, 0x00000001U, 0x7FFFFFFFU},
    {ArithmeticOperation::kSubtract, 0x00000000U, 0xFFFFFFFFU, 0x00000001U},
    {ArithmeticOperation::kSubtract, 0x89ABCDEFU, 0x7F4A7C15U, 0x0A6151DAU},
    {ArithmeticOperation::kMultiply, 0x55555555U, 0x00000001U, 0x55555555U},
    {ArithmeticOperation::kMultiply, 0xAAAAAAAAU, 0x00000001U, 0xAAAAAAAAU},
    {ArithmeticOperation::kMultiply, 0x55555555U, 0x00000003U, 0xFFFFFFFFU},
    {ArithmeticOperation::kMultiply, 0xFFFFFFFFU, 0xFFFFFFFFU, 0x00000001U},
    {ArithmeticOperation::kMultiply, 0x89ABCDEFU, 0x7F4A7C15U, 0x9AEDA89BU},
    {ArithmeticOperation::kMultiply, 0x80000000U, 0x00000002U, 0x00000000U},
    {ArithmeticOperation::kDivide, 0xFFFFFFFFU, 0x00000003U, 0x55555555U},
    {ArithmeticOperation::kDivide, 0xAAAAAAAAU, 0x00000001U, 0xAAAAAAAAU},
    {ArithmeticOperation::kDivide, 0xFFFFFFFFU, 0xFFFFFFFFU, 0x00000001U},
    {ArithmeticOperation::kDivide, 0xFFFFFFFEU, 0xFFFFFFFFU, 0x00000000U},
    {ArithmeticOperation::kDivide, 0x7F4A7C15U, 0x000089ABU, 0x0000ECB4U},
    {ArithmeticOperation::kDivide, 0x80000000U, 0x00010000U, 0x00008000U},
}};

inline constexpr std::array<CpuCase<WordOperation, std::uint32_t>, 16U> kWords32{{
    {WordOperation::kRemainder, 0x55555555U, 0xFFFFFFFFU, 0x55555555U},
    {WordOperation::kRemainder, 0xAAAAAAAAU, 0xFFFFFFFFU, 0xAAAAAAAAU},
    {WordOperation::kRemainder, 0xFFFFFFFFU, 0xFFFFFFFFU, 0x00000000U},
    {WordOperation::kRemainder, 0x7F4A7C15U, 0x000089ABU, 0x00000BD9U},
    {WordOperation::kAnd, 0x55555555U, 0x33333333U, 0x11111111U},
    {WordOperation::kAnd, 0xAAAAAAAAU, 0xCCCCCCCCU, 0x88888888U},
    {WordOperation::kAnd, 0x55555555U, 0xCCCCCCCCU, 0x44444444U},
    {WordOperation::kAnd, 0xAAAAAAAAU, 0x33333333U, 0x22222222U},
    {WordOperation::kOr, 0x55555555U, 0x33333333U, 0x77777777U},
    {WordOperation::kOr, 0xAAAAAAAAU, 0xCCCCCCCCU, 0xEEEEEEEEU},
    {WordOperation::kOr, 0x55555555U, 0xCCCCCCCCU, 0xDDDDDDDDU},
    {WordOperation::kOr, 0xAAAAAAAAU, 0x33333333U, 0xBBBBBBBBU},
    {WordOperation::kExclusiveOr, 0x55555555U, 0x33333333U, 0x66666666U},
    {WordOperation::kExclusiveOr, 0xAAAAAAAAU, 0xCCCCCCCCU, 0x66666666U},
    {WordOperation::kExclusiveOr, 0x55555555U, 0xCCCCCCCCU, 0x99999999U},
    {WordOperation::kExclusiveOr, 0xAAAAAAAAU, 0x33333333U, 0x99999999U},
}};

inline constexpr std::array<CpuCase<ArithmeticOperation, std::uint64_t>, 24U> kArithmetic64{{
    {ArithmeticOperation::kAdd, 0xFFFFFFFFFFFFFFFFU, 0x0000000000000001U, 0x0000000000000000U},
    {ArithmeticOperation::kAdd, 0x5555555555555555U, 0xAAAAAAAAAAAAAAAAU, 0xFFFFFFFFFFFFFFFFU},
    {ArithmeticOperation::kAdd, 0xAAAAAAAAAAAAAAAAU, 0xAAAAAAAAAAAAAAAAU, 0x5555555555555554U},
    {ArithmeticOperation::kAdd, 0x5555555555555555U, 0x5555555555555555U, 0xAAAAAAAAAAAAAAAAU},
    {ArithmeticOperation::kAdd, 0x8000000000000000U, 0x8000000000000000U, 0x0000000000000000U},
    {ArithmeticOperation::kAdd, 0x0123456789ABCDEFU, 0x9E3779B97F4A7C15U, 0x9F5ABF2108F64A04U},
    {ArithmeticOperation::kSubtract, 0x0000000000000000U, 0x0000000000000001U, 0xFFFFFFFFFFFFFFFFU},
    {ArithmeticOperation::kSubtract, 0x5555555555555555U, 0xAAAAAAAAAAAAAAAAU, 0xAAAAAAAAAAAAAAABU},
    {ArithmeticOperation::kSubtract, 0xAAAAAAAAAAAAAAAAU, 0x5555555555555555U, 0x5555555555555555U},
    {ArithmeticOperation::kSubtract, 0x8000000000000000U, 0x0000000000000001U, 0x7FFFFFFFFFFFFFFFU},
    {ArithmeticOperation::kSubtract, 0x0000000000000000U, 0xFFFFFFFFFFFFFFFFU, 0x0000000000000001U},
    {ArithmeticOperation::kSubtract, 0x0123456789ABCDEFU, 0x9E3779B97F4A7C15U, 0x62EBCBAE0A6151DAU},
    {ArithmeticOperation::kMultiply, 0x5555555555555555U, 0x0000000000000001U, 0x5555555555555555U},
    {ArithmeticOperation::kMultiply, 0xAAAAAAAAAAAAAAAAU, 0x0000000000000001U, 0xAAAAAAAAAAAAAAAAU},
    {ArithmeticOperation::kMultiply, 0x5555555555555555U, 0x0000000000000003U, 0xFFFFFFFFFFFFFFFFU},
    {ArithmeticOperation::kMultiply, 0xFFFFFFFFFFFFFFFFU, 0xFFFFFFFFFFFFFFFFU, 0x0000000000000001U},
    {ArithmeticOperation::kMultiply, 0x0123456789ABCDEFU, 0x9E3779B97F4A7C15U, 0x0C93A7B79AEDA89BU},
    {ArithmeticOperation::kMultiply, 0x8000000000000000U, 0x0000000000000002U, 0x0000000000000000U},
    {ArithmeticOperation::kDivide, 0xFFFFFFFFFFFFFFFFU, 0x0000000000000003U, 0x5555555555555555U},
    {ArithmeticOperation::kDivide, 0xAAAAAAAAAAAAAAAAU, 0x0000000000000001U, 0xAAAAAAAAAAAAAAAAU},
    {ArithmeticOperation::kDivide, 0xFFFFFFFFFFFFFFFFU, 0xFFFFFFFFFFFFFFFFU, 0x0000000000000001U},
    {ArithmeticOperation::kDivide, 0xFFFFFFFFFFFFFFFEU, 0xFFFFFFFFFFFFFFFFU, 0x0000000000000000U},
    {ArithmeticOperation::kDivide, 0x9E3779B97F4A7C15U, 0x0000000001234567U, 0x0000008B0EC23DC2U},
    {ArithmeticOperation::kDivide, 0x8000000000000000U, 0x0000000100000000U, 0x0000000080000000U},
}};

inline constexpr std::array<CpuCase<WordOperation, std::uint64_t>, 16U> kWords64{{
    {WordOperation::kRemainder, 0x5555555555555555U, 0xFFFFFFFFFFFFFFFFU, 0x5555555555555555U},
    {WordOperation::kRemainder, 0xAAAAAAAAAAAAAAAAU, 0xFFFFFFFFFFFFFFFFU, 0xAAAAAAAAAAAAAAAAU},
    {WordOperation::kRemainder, 0xFFFFFFFFFFFFFFFFU, 0xFFFFFFFFFFFFFFFFU, 0x0000000000000000U},
    {WordOperation::kRemainder, 0x9E3779B97F4A7C15U, 0x0000000001234567U, 0x0000000000F85907U},
    {WordOperation::kAnd, 0x5555555555555555U, 0x3333333333333333U, 0x1111111111111111U},
    {WordOperation::kAnd, 0xAAAAAAAAAAAAAAAAU, 0xCCCCCCCCCCCCCCCCU, 0x8888888888888888U},
    {WordOperation::kAnd, 0x5555555555555555U, 0xCCCCCCCCCCCCCCCCU, 0x4444444444444444U},
    {WordOperation::kAnd, 0xAAAAAAAAAAAAAAAAU, 0x3333333333333333U, 0x2222222222222222U},
    {WordOperation::kOr, 0x5555555555555555U, 0x3333333333333333U, 0x7777777777777777U},
    {WordOperation::kOr, 0xAAAAAAAAAAAAAAAAU, 0xCCCCCCCCCCCCCCCCU, 0xEEEEEEEEEEEEEEEEU},
    {WordOperation::kOr, 0x5555555555555555U, 0xCCCCCCCCCCCCCCCCU, 0xDDDDDDDDDDDDDDDDU},
    {WordOperation::kOr, 0xAAAAAAAAAAAAAAAAU, 0x3333333333333333U, 0xBBBBBBBBBBBBBBBBU},
    {WordOperation::kExclusiveOr, 0x5555555555555555U, 0x3333333333333333U, 0x6666666666666666U},
    {WordOperation::kExclusiveOr, 0xAAAAAAAAAAAAAAAAU, 0xCCCCCCCCCCCCCCCCU, 0x6666666666666666U},
    {WordOperation::kExclusiveOr, 0x5555555555555555U, 0xCCCCCCCCCCCCCCCCU, 0x9999999999999999U},
    {WordOperation::kExclusiveOr, 0xAAAAAAAAAAAAAAAAU, 0x3333333333333333U, 0x9999999999999999U},
}};

inline constexpr std::array<CpuCase<ArithmeticOperation, std::uint32_t>, 20U> kFloatArithmetic{{
    {ArithmeticOperation::kAdd, 0x3F800000U, 0x40000000U, 0x40400000U},
    {ArithmeticOperation::kAdd, 0x55555555U, 0x00000000U, 0x55555555U},
    {ArithmeticOperation::kAdd, 0xAAAAAAAAU, 0x00000000U, 0xAAAAAAAAU},
    {ArithmeticOperation::kAdd, 0x3DCCCCCDU, 0x3E4CCCCDU, 0x3E99999AU},
    {ArithmeticOperation::kAdd, 0x4B800000U, 0xBF800000U, 0x4B7FFFFFU},
    {ArithmeticOperation::kSubtract, 0x40400000U, 0x40000000U, 0x3F800000U},
    {ArithmeticOperation::kSubtract, 0x55555555U, 0x00000000U, 0x55555555U},
    {ArithmeticOperation::kSubtract, 0xAAAAAAAAU, 0x00000000U, 0xAAAAAAAAU},
    {ArithmeticOperation::kSubtract, 0x3F800001U, 0x3F800000U, 0x34000000U},
    {ArithmeticOperation::kSubtract, 0x3DCCCCCDU, 0x40400000U, 0xC039999AU},
    {ArithmeticOperation::kMultiply, 0x55555555U, 0x3F800000U, 0x55555555U},
    {ArithmeticOperation::kMultiply, 0xAAAAAAAAU, 0x3F800000U, 0xAAAAAAAAU},
    {ArithmeticOperation::kMultiply, 0x3DCCCCCDU, 0x3DCCCCCDU, 0x3C23D70BU},
    {ArithmeticOperation::kMultiply, 0x40400000U, 0xBF800000U, 0xC0400000U},
    {ArithmeticOperation::kMultiply, 0x3F800001U, 0x3F800001U, 0x3F800002U},
    {ArithmeticOperation::kDivide, 0x55555555U, 0x3F800000U, 0x55555555U},
    {ArithmeticOperation::kDivide, 0xAAAAAAAAU, 0x3F800000U, 0xAAAAAAAAU},
    {ArithmeticOperation::kDivide, 0x3F800000U, 0x40400000U, 0x3EAAAAABU},
    {ArithmeticOperation::kDivide, 0x40000000U, 0x40400000U, 0x3F2AAAABU},
    {ArithmeticOperation::kDivide, 0xBF800000U, 0x41200000U, 0xBDCCCCCDU},
}};

/// Rounding of ties and of the rest in both directions, denormal operands and results, overflow, infinity.
inline constexpr std::array<CpuCase<ArithmeticOperation, std::uint32_t>, 16U> kFloatMode{{
    {ArithmeticOperation::kAdd, 0x3F800000U, 0x33800000U, 0x3F800000U},
    {ArithmeticOperation::kAdd, 0x3F800001U, 0x33800000U, 0x3F800002U},
    {ArithmeticOperation::kAdd, 0x3F800000U, 0x33C00000U, 0x3F800001U},
    {ArithmeticOperation::kSubtract, 0xBF800000U, 0x33800000U, 0xBF800000U},
    {ArithmeticOperation::kSubtract, 0xBF800000U, 0x33C00000U, 0xBF800001U},
    {ArithmeticOperation::kMultiply, 0x00800000U, 0x3F000000U, 0x00400000U},
    {ArithmeticOperation::kMultiply, 0x80800000U, 0x3F000000U, 0x80400000U},
    {ArithmeticOperation::kAdd, 0x00000001U, 0x00000001U, 0x00000002U},
    {ArithmeticOperation::kSubtract, 0x00800000U, 0x00000001U, 0x007FFFFFU},
    {ArithmeticOperation::kDivide, 0x00800000U, 0x40000000U, 0x00400000U},
    {ArithmeticOperation::kMultiply, 0x7F7FFFFFU, 0x40000000U, 0x7F800000U},
    {ArithmeticOperation::kAdd, 0x7F800000U, 0x3F800000U, 0x7F800000U},
    {ArithmeticOperation::kDivide, 0x3F800000U, 0x00000000U, 0x7F800000U},
    {ArithmeticOperation::kDivide, 0xBF800000U, 0x00000000U, 0xFF800000U},
    {ArithmeticOperation::kDivide, 0x3F800000U, 0x7F800000U, 0x00000000U},
    {ArithmeticOperation::kSubtract, 0xFF800000U, 0x7F7FFFFFU, 0xFF800000U},
}};

inline constexpr std::array<CpuCase<ArithmeticOperation, std::uint64_t>, 20U> kDoubleArithmetic{{
    {ArithmeticOperation::kAdd, 0x3FF0000000000000U, 0x4000000000000000U, 0x4008000000000000U},
    {ArithmeticOperation::kAdd, 0x5555555555555555U, 0x0000000000000000U, 0x5555555555555555U},
    {ArithmeticOperation::kAdd, 0xAAAAAAAAAAAAAAAAU, 0x0000000000000000U, 0xAAAAAAAAAAAAAAAAU},
    {ArithmeticOperation::kAdd, 0x3FB999999999999AU, 0x3FC999999999999AU, 0x3FD3333333333334U},
    {ArithmeticOperation::kAdd, 0x4340000000000000U, 0xBFF0000000000000U, 0x433FFFFFFFFFFFFFU},
    {ArithmeticOperation::kSubtract, 0x4008000000000000U, 0x4000000000000000U, 0x3FF0000000000000U},
    {ArithmeticOperation::kSubtract, 0x5555555555555555U, 0x0000000000000000U, 0x5555555555555555U},
    {ArithmeticOperation::kSubtract, 0xAAAAAAAAAAAAAAAAU, 0x0000000000000000U, 0xAAAAAAAAAAAAAAAAU},
    {ArithmeticOperation::kSubtract, 0x3FF0000000000001U, 0x3FF0000000000000U, 0x3CB0000000000000U},
    {ArithmeticOperation::kSubtract, 0x3FB999999999999AU, 0x4008000000000000U, 0xC007333333333333U},
    {ArithmeticOperation::kMultiply, 0x5555555555555555U, 0x3FF0000000000000U, 0x5555555555555555U},
    {ArithmeticOperation::kMultiply, 0xAAAAAAAAAAAAAAAAU, 0x3FF0000000000000U, 0xAAAAAAAAAAAAAAAAU},
    {ArithmeticOperation::kMultiply, 0x3FB999999999999AU, 0x3FB999999999999AU, 0x3F847AE147AE147CU},
    {ArithmeticOperation::kMultiply, 0x4008000000000000U, 0xBFF0000000000000U, 0xC008000000000000U},
    {ArithmeticOperation::kMultiply, 0x3FF0000000000001U, 0x3FF0000000000001U, 0x3FF0000000000002U},
    {ArithmeticOperation::kDivide, 0x5555555555555555U, 0x3FF0000000000000U, 0x5555555555555555U},
    {ArithmeticOperation::kDivide, 0xAAAAAAAAAAAAAAAAU, 0x3FF0000000000000U, 0xAAAAAAAAAAAAAAAAU},
    {ArithmeticOperation::kDivide, 0x3FF0000000000000U, 0x4008000000000000U, 0x3FD5555555555555U},
    {ArithmeticOperation::kDivide, 0x4000000000000000U, 0x4008000000000000U, 0x3FE5555555555555U},
    {ArithmeticOperation::kDivide, 0xBFF0000000000000U, 0x4024000000000000U, 0xBFB999999999999AU},
}};

inline constexpr std::array<CpuCase<ArithmeticOperation, std::uint64_t>, 16U> kDoubleMode{{
    {ArithmeticOperation::kAdd, 0x3FF0000000000000U, 0x3CA0000000000000U, 0x3FF0000000000000U},
    {ArithmeticOperation::kAdd, 0x3FF0000000000001U, 0x3CA0000000000000U, 0x3FF0000000000002U},
    {ArithmeticOperation::kAdd, 0x3FF0000000000000U, 0x3CA8000000000000U, 0x3FF0000000000001U},
    {ArithmeticOperation::kSubtract, 0xBFF0000000000000U, 0x3CA0000000000000U, 0xBFF0000000000000U},
    {ArithmeticOperation::kSubtract, 0xBFF0000000000000U, 0x3CA8000000000000U, 0xBFF0000000000001U},
    {ArithmeticOperation::kMultiply, 0x0010000000000000U, 0x3FE0000000000000U, 0x0008000000000000U},
    {ArithmeticOperation::kMultiply, 0x8010000000000000U, 0x3FE0000000000000U, 0x8008000000000000U},
    {ArithmeticOperation::kAdd, 0x0000000000000001U, 0x0000000000000001U, 0x0000000000000002U},
    {ArithmeticOperation::kSubtract, 0x0010000000000000U, 0x0000000000000001U, 0x000FFFFFFFFFFFFFU},
    {ArithmeticOperation::kDivide, 0x0010000000000000U, 0x4000000000000000U, 0x0008000000000000U},
    {ArithmeticOperation::kMultiply, 0x7FEFFFFFFFFFFFFFU, 0x4000000000000000U, 0x7FF0000000000000U},
    {ArithmeticOperation::kAdd, 0x7FF0000000000000U, 0x3FF0000000000000U, 0x7FF0000000000000U},
    {ArithmeticOperation::kDivide, 0x3FF0000000000000U, 0x0000000000000000U, 0x7FF0000000000000U},
    {ArithmeticOperation::kDivide, 0xBFF0000000000000U, 0x0000000000000000U, 0xFFF0000000000000U},
    {ArithmeticOperation::kDivide, 0x3FF0000000000000U, 0x7FF0000000000000U, 0x0000000000000000U},
    {ArithmeticOperation::kSubtract, 0xFFF0000000000000U, 0x7FEFFFFFFFFFFFFFU, 0xFFF0000000000000U},
}};
/// The powers of two of a word, so that what a shift gives is compared with what no shift made.
template <typename Word>
constexpr auto make_powers() noexcept {
    std::array<Word, std::numeric_limits<Word>::digits> powers{};
    Word power = 1U;
    for (Word& each : powers) {
        each = power;
        power = static_cast<Word>(power + power);
    }
    return powers;
}

template <typename Word>
inline constexpr auto kPowers = make_powers<Word>();

}  // namespace mamori::safety::detail

#endif  // MAMORI_SAFETY_SELF_TEST_CPU_PATTERNS_HPP
