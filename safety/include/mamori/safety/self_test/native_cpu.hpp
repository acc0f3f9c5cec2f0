// SPDX-License-Identifier: Apache-2.0
/// @file
/// The processor as the CPU check uses it: one operation per function, done by the processor when the program
/// runs, and not by the compiler before.
///
/// @satisfies SWR-SLF-008, SWR-SLF-009      Design: docs/design/self_tests.md#processor
#ifndef MAMORI_SAFETY_SELF_TEST_NATIVE_CPU_HPP
#define MAMORI_SAFETY_SELF_TEST_NATIVE_CPU_HPP

#include <cstdint>
#include <type_traits>

#include "mamori/kernel/base/assert.hpp"
#include "mamori/safety/base/opaque.hpp"

namespace mamori::safety {

/// Operations on two numbers, of 32 or 64 bits, unsigned or floating point.
enum class ArithmeticOperation : std::uint8_t { kAdd, kSubtract, kMultiply, kDivide };
/// Operations on two unsigned words of 32 or 64 bits. Shifts are by the second one, below the width.
enum class WordOperation : std::uint8_t {
    kRemainder,
    kAnd,
    kOr,
    kExclusiveOr,
    kShiftLeft,
    kShiftRight,
    kShiftRightSigned,  ///< fills with the highest bit
};

/// The processor that runs this.
struct NativeCpu {
    template <typename T>
    static T calc(ArithmeticOperation operation, T a, T b) noexcept {
        const T x = hide(a);
        const T y = hide(b);
        switch (operation) {
            case ArithmeticOperation::kAdd:
                return x + y;
            case ArithmeticOperation::kSubtract:
                return x - y;
            case ArithmeticOperation::kMultiply:
                return x * y;
            case ArithmeticOperation::kDivide:
                return x / y;
        }
        MAMORI_INVARIANT(1, false);
        return x;
    }
    template <typename T>
    static T calc(WordOperation operation, T a, T b) noexcept {
        const T x = hide(a);
        const T y = hide(b);
        switch (operation) {
            case WordOperation::kRemainder:
                return x % y;
            case WordOperation::kAnd:
                return x & y;
            case WordOperation::kOr:
                return x | y;
            case WordOperation::kExclusiveOr:
                return x ^ y;
            case WordOperation::kShiftLeft:
                return x << y;
            case WordOperation::kShiftRight:
                return x >> y;
            case WordOperation::kShiftRightSigned:
                return static_cast<T>(static_cast<std::make_signed_t<T>>(x) >> y);
        }
        MAMORI_INVARIANT(2, false);
        return x;
    }
    template <typename T>
    static bool is_less(T a, T b) noexcept {
        return hide(a) < hide(b);
    }
    template <typename T>
    static bool is_equal(T a, T b) noexcept {
        return hide(a) == hide(b);
    }
};

}  // namespace mamori::safety

#endif  // MAMORI_SAFETY_SELF_TEST_NATIVE_CPU_HPP
