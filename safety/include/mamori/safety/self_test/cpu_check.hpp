// SPDX-License-Identifier: Apache-2.0
/// @file
/// Self test of the processor: integer and floating-point operations, shifts, comparisons, and the mode of
/// the floating-point unit, against results that are known exactly.
///
/// @satisfies SWR-SLF-008, SWR-SLF-009      Design: docs/design/self_tests.md#processor
/// Source:   IEC 61508-7:2010 A.3.1, A.3.2 (self-test by software: patterns, walking bit)
#ifndef MAMORI_SAFETY_SELF_TEST_CPU_CHECK_HPP
#define MAMORI_SAFETY_SELF_TEST_CPU_CHECK_HPP

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <type_traits>

#include "mamori/safety/self_test/cpu_patterns.hpp"
#include "mamori/safety/self_test/native_cpu.hpp"
#include "mamori/safety/self_test/self_test.hpp"

namespace mamori::safety {

/// Check of the processor that calls it. Compiled with the options of the project: fast-math, which takes
/// not-a-number for impossible, would make it fail.
///
/// Thread safety: none. Time: a step does less than 800 operations. Memory: no heap; tables of 5 KiB.
/// @tparam Cpu how an operation is done; NativeCpu for the real one.
template <typename Cpu>
class CpuCheck final : public SelfTest {
  public:
    void begin() noexcept override { step_ = 0U; }
    SelfTestStatus step() noexcept override {
        const bool is_good = check(step_);
        ++step_;
        if (!is_good) {
            return SelfTestStatus::kFailed;
        }
        return step_ == kStepCount ? SelfTestStatus::kPassed : SelfTestStatus::kRunning;
    }
    std::size_t get_step_count() const noexcept override { return kStepCount; }

  private:
    static constexpr std::size_t kStepCount = 6U;

    static bool check(std::size_t step) noexcept {
        switch (step) {
            case 0U:
                return check_cases<std::uint32_t, detail::kArithmetic32>() &&
                       check_cases<std::uint32_t, detail::kWords32>() && check_bits<std::uint32_t>();
            case 1U:
                return check_cases<std::uint64_t, detail::kArithmetic64>() &&
                       check_cases<std::uint64_t, detail::kWords64>() && check_bits<std::uint64_t>();
            case 2U:
                return check_order<std::int32_t>(-1, 1) && check_order<std::int64_t>(-1, 1) &&
                       check_order<float>(-1.0F, 1.0F) && check_order<double>(-1.0, 1.0);
            case 3U:
                return check_cases<float, detail::kFloatArithmetic>() &&
                       check_cases<double, detail::kDoubleArithmetic>();
            case 4U:
                return check_cases<float, detail::kFloatMode>() && check_cases<double, detail::kDoubleMode>();
            case 5U:
                return check_not_a_number<float>() && check_not_a_number<double>();
            default:
                return false;  // a step that is none was not done
        }
    }

    template <typename T, const auto& kCases>
    static bool check_cases() noexcept {
        using Bits = std::decay_t<decltype(kCases[0].result)>;
        Bits difference = 0U;
        for (const auto& one : kCases) {
            const T result =
                Cpu::calc(one.operation, __builtin_bit_cast(T, one.a), __builtin_bit_cast(T, one.b));
            difference |= static_cast<Bits>(__builtin_bit_cast(Bits, result) ^ one.result);
        }
        return difference == 0U;
    }

    /// Shifts by every distance, and comparisons of words that differ in one bit.
    template <typename Word>
    static bool check_bits() noexcept {
        constexpr auto& kPowers = detail::kPowers<Word>;
        constexpr std::size_t kBits = kPowers.size();
        constexpr Word kAll = std::numeric_limits<Word>::max();
        constexpr Word kTop = kPowers[kBits - 1U];
        Word difference = 0U;
        bool is_good = true;
        for (std::size_t n = 0U; n < kBits; ++n) {
            const auto distance = static_cast<Word>(n);
            const Word up = kPowers[n];
            const Word down = kPowers[kBits - 1U - n];
            difference |= Cpu::calc(WordOperation::kShiftLeft, Word{1U}, distance) ^ up;
            difference |= Cpu::calc(WordOperation::kShiftLeft, kAll, distance) ^ (kAll - up + 1U);
            difference |= Cpu::calc(WordOperation::kShiftRight, kTop, distance) ^ down;
            difference |= Cpu::calc(WordOperation::kShiftRight, kAll, distance) ^ (down - 1U + down);
            difference |= Cpu::calc(WordOperation::kShiftRightSigned, kTop, distance) ^ (kAll - down + 1U);
            difference |= Cpu::calc(WordOperation::kShiftRightSigned, kTop - 1U, distance) ^ (down - 1U);
            const bool is_told_apart = !Cpu::is_equal(up, Word{0U}) && !Cpu::is_equal(kAll - up, kAll) &&
                                       Cpu::is_less(Word{0U}, up) && !Cpu::is_less(up, Word{0U});
            is_good = is_good && is_told_apart && Cpu::is_equal(up, up);
        }
        return is_good && difference == 0U;
    }

    /// @param[in] low less than `high`, of the other sign.
    template <typename T>
    static bool check_order(T low, T high) noexcept {
        constexpr T kLowest = std::numeric_limits<T>::lowest();
        constexpr T kLargest = std::numeric_limits<T>::max();
        return Cpu::is_less(low, high) && !Cpu::is_less(high, low) && !Cpu::is_less(low, low) &&
               Cpu::is_less(kLowest, kLargest) && !Cpu::is_less(kLargest, kLowest) &&
               Cpu::is_equal(low, low) && !Cpu::is_equal(low, high);
    }

    /// What is not a number comes out of what has no result, and is in no relation to anything.
    template <typename T>
    static bool check_not_a_number() noexcept {
        constexpr T kInfinity = std::numeric_limits<T>::infinity();
        const std::array<T, 4U> none{{
            Cpu::calc(ArithmeticOperation::kSubtract, kInfinity, kInfinity),
            Cpu::calc(ArithmeticOperation::kMultiply, T{0}, kInfinity),
            Cpu::calc(ArithmeticOperation::kDivide, T{0}, T{0}),
            Cpu::calc(ArithmeticOperation::kAdd, std::numeric_limits<T>::quiet_NaN(), T{1}),
        }};
        bool is_good = true;
        for (const T each : none) {
            const bool is_related =
                Cpu::is_equal(each, each) || Cpu::is_less(each, T{1}) || Cpu::is_less(T{1}, each);
            is_good = is_good && !is_related;
        }
        return is_good;
    }

    std::size_t step_{0U};
};

}  // namespace mamori::safety

#endif  // MAMORI_SAFETY_SELF_TEST_CPU_CHECK_HPP
