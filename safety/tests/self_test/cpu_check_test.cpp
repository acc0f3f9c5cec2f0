// SPDX-License-Identifier: Apache-2.0
// Goal: an operation of the processor that gives something else is found, and so is a floating-point unit in
// another mode. Method: each bit of the result of each operation is stuck at 0 and at 1; the unit of the test
// machine is switched to its other rounding modes; flushed denormals and comparisons that always say the
// same.
#include "mamori/safety/self_test/cpu_check.hpp"

#include <cfenv>
#include <cmath>
#include <optional>
#include <utility>

#include "mamori/trace/verifies.hpp"
#include "mamori/verification/failed_check.hpp"

namespace mamori::safety {
namespace {

using namespace verification;

/// The real processor with one fault between it and the check.
struct FaultyCpu {
    enum class Type { kNone, kWord32, kWord64, kSigned32, kSigned64, kFloat, kDouble };
    enum class Relation {
        kSound,
        kNeverLess,
        kAlwaysLess,
        kLessOrEqual,
        kLowestIsNotLess,
        kLargestIsLess,
        kNeverEqual,
        kAlwaysEqual,
        kEqualWithCommonBit,
        kBlindBit,
        kNanIsEqual,
        kNanIsLess,
        kNanIsMore,
    };

    static inline Type type{Type::kNone};      ///< whose results have a stuck bit
    static inline unsigned int operation{0U};  ///< arithmetic ones first
    static inline unsigned int bit{0U};
    static inline bool stuck_at{false};
    static inline std::optional<std::uint64_t> second{};  ///< stuck with this second operand only
    static inline Type flushed{Type::kNone};              ///< denormal operands and results are zero
    static inline bool does_saturate{false};              ///< the largest number in place of infinity
    static inline bool has_nan{true};
    static inline std::optional<ArithmeticOperation> without_nan{};  ///< the one that gives zero in its place
    static inline Type compared{Type::kNone};
    static inline Relation relation{Relation::kSound};

    static void mend() {
        type = Type::kNone;
        stuck_at = false;
        second.reset();
        flushed = Type::kNone;
        does_saturate = false;
        has_nan = true;
        without_nan.reset();
        compared = Type::kNone;
        relation = Relation::kSound;
    }

    template <typename T>
    static constexpr Type get_type() {
        if constexpr (std::is_same_v<T, float>) {
            return Type::kFloat;
        } else if constexpr (std::is_same_v<T, double>) {
            return Type::kDouble;
        } else {
            constexpr bool kIsSigned = std::is_signed_v<T>;
            constexpr Type kShort = kIsSigned ? Type::kSigned32 : Type::kWord32;
            return sizeof(T) == 4U ? kShort : (kIsSigned ? Type::kSigned64 : Type::kWord64);
        }
    }
    template <typename T>
    static T corrupt(unsigned int done, T result) {
        using Bits = std::conditional_t<sizeof(T) == 4U, std::uint32_t, std::uint64_t>;
        if (type != get_type<T>() || done != operation) {
            return result;
        }
        const Bits mask = Bits{1U} << bit;
        const Bits bits = __builtin_bit_cast(Bits, result);
        return __builtin_bit_cast(T, static_cast<Bits>(stuck_at ? bits | mask : bits & ~mask));
    }
    template <typename T>
    static T flush(T value) {
        if constexpr (std::is_floating_point_v<T>) {
            return flushed == get_type<T>() && std::fpclassify(value) == FP_SUBNORMAL ? T{0} : value;
        } else {
            return value;
        }
    }
    template <typename T>
    static T calc(ArithmeticOperation done, T a, T b) {
        T result = flush(NativeCpu::calc(done, flush(a), flush(b)));
        if constexpr (std::is_floating_point_v<T>) {
            if (does_saturate && std::isinf(result)) {
                result = std::copysign(std::numeric_limits<T>::max(), result);
            }
            if ((!has_nan || without_nan == done) && std::isnan(result)) {
                result = T{0};
            }
        }
        return corrupt(static_cast<unsigned int>(done), result);
    }
    template <typename T>
    static T calc(WordOperation done, T a, T b) {
        const T result = NativeCpu::calc(done, a, b);
        return second.value_or(b) == b ? corrupt(4U + static_cast<unsigned int>(done), result) : result;
    }
    template <typename T>
    static bool is_less(T a, T b) {
        const bool sound = NativeCpu::is_less(a, b);
        if (compared != get_type<T>()) {
            return sound;
        }
        if constexpr (std::is_floating_point_v<T>) {
            if (std::isnan(a) || std::isnan(b)) {
                return std::isnan(a) ? relation == Relation::kNanIsLess : relation == Relation::kNanIsMore;
            }
        }
        switch (relation) {
            case Relation::kNeverLess:
                return false;
            case Relation::kAlwaysLess:
                return true;
            case Relation::kLessOrEqual:
                return sound || NativeCpu::is_equal(a, b);
            case Relation::kLowestIsNotLess:
                return sound && a != std::numeric_limits<T>::lowest();
            case Relation::kLargestIsLess:
                return sound || a == std::numeric_limits<T>::max();
            default:
                return sound;
        }
    }
    template <typename T>
    static bool is_equal(T a, T b) {
        const bool sound = NativeCpu::is_equal(a, b);
        if (compared != get_type<T>()) {
            return sound;
        }
        if constexpr (std::is_integral_v<T>) {
            if (relation == Relation::kBlindBit) {
                return (static_cast<std::uint64_t>(a) | (std::uint64_t{1} << bit)) ==
                       (static_cast<std::uint64_t>(b) | (std::uint64_t{1} << bit));
            }
            if (relation == Relation::kEqualWithCommonBit && (a & b) != 0) {
                return true;
            }
        } else if (relation == Relation::kNanIsEqual && std::isnan(a)) {
            return true;
        }
        return relation == Relation::kAlwaysEqual || (relation != Relation::kNeverEqual && sound);
    }
};

template <typename Cpu>
SelfTestStatus run_pass() {
    CpuCheck<Cpu> sut;
    sut.begin();
    SelfTestStatus status = SelfTestStatus::kRunning;
    for (std::size_t i = 0U; i < sut.get_step_count() && status == SelfTestStatus::kRunning; ++i) {
        status = sut.step();
    }
    return status;
}

class CpuCheckTest : public ::testing::Test {
  protected:
    using Cpu = FaultyCpu;
    using Relation = FaultyCpu::Relation;

    ~CpuCheckTest() override {
        Cpu::mend();
        static_cast<void>(std::fesetround(FE_TONEAREST));
    }
    static bool is_found() { return run_pass<Cpu>() == SelfTestStatus::kFailed; }

    /// Every bit of every operation of one type, stuck at 0 and at 1.
    static void expect_every_stuck_bit_found(Cpu::Type type, unsigned int operations, unsigned int bits) {
        Cpu::type = type;
        for (Cpu::operation = 0U; Cpu::operation < operations; ++Cpu::operation) {
            for (Cpu::bit = 0U; Cpu::bit < bits; ++Cpu::bit) {
                for (const bool value : {false, true}) {
                    Cpu::stuck_at = value;
                    EXPECT_TRUE(is_found()) << "operation " << Cpu::operation << " bit " << Cpu::bit << value;
                }
            }
        }
    }
};

TEST_F(CpuCheckTest, SoundProcessorPassesAgainAndAgain) {
    verifies("SWR-SLF-008");
    CpuCheck<NativeCpu> sut;

    for (std::size_t pass = 0U; pass < 2U; ++pass) {
        sut.begin();
        for (std::size_t step = 1U; step < sut.get_step_count(); ++step) {
            ASSERT_EQ(sut.step(), SelfTestStatus::kRunning) << step;
        }
        ASSERT_EQ(sut.step(), SelfTestStatus::kPassed);
    }
    EXPECT_EQ(run_pass<FaultyCpu>(), SelfTestStatus::kPassed) << "no fault is injected";
}

TEST_F(CpuCheckTest, PowersThatShiftsAreComparedWithAreRight) {
    verifies("SWR-SLF-008", Technique::kBackToBack);
    std::array<std::uint64_t, 64U> powers{};
    powers = detail::make_powers<std::uint64_t>();

    for (std::size_t n = 0U; n < 64U; ++n) {
        EXPECT_EQ(powers[n], std::uint64_t{1} << n);
    }
}

TEST_F(CpuCheckTest, EveryStuckBitOfEveryWordOperationIsFound) {
    verifies("SWR-SLF-008", Technique::kFaultInjection, Polarity::kViolation);

    expect_every_stuck_bit_found(Cpu::Type::kWord32, 11U, 32U);
    expect_every_stuck_bit_found(Cpu::Type::kWord64, 11U, 64U);
}

/// The bits of a result that a shift by `distance` can set.
bool carries(WordOperation shift, unsigned int bit, unsigned int distance, unsigned int bits) {
    if (shift == WordOperation::kShiftLeft) {
        return bit >= distance;
    }
    return shift == WordOperation::kShiftRightSigned || bit + distance < bits;
}

TEST_F(CpuCheckTest, EveryPathOfAShiftThatIsStuckAtZeroIsFound) {
    verifies("SWR-SLF-008", Technique::kFaultInjection, Polarity::kViolation);

    for (const auto& [type, bits] : {std::pair{Cpu::Type::kWord32, 32U}, {Cpu::Type::kWord64, 64U}}) {
        Cpu::type = type;
        for (const WordOperation shift :
             {WordOperation::kShiftLeft, WordOperation::kShiftRight, WordOperation::kShiftRightSigned}) {
            Cpu::operation = 4U + static_cast<unsigned int>(shift);
            for (unsigned int distance = 0U; distance < bits; ++distance) {
                Cpu::second = distance;
                for (Cpu::bit = 0U; Cpu::bit < bits; ++Cpu::bit) {
                    ASSERT_EQ(is_found(), carries(shift, Cpu::bit, distance, bits))
                        << Cpu::operation << " by " << distance << " bit " << Cpu::bit;
                }
            }
        }
    }
}

TEST_F(CpuCheckTest, EveryStuckBitOfEveryFloatingPointOperationIsFound) {
    verifies("SWR-SLF-008", Technique::kFaultInjection, Polarity::kViolation);

    expect_every_stuck_bit_found(Cpu::Type::kFloat, 4U, 32U);
    expect_every_stuck_bit_found(Cpu::Type::kDouble, 4U, 64U);
}

TEST_F(CpuCheckTest, WrongComparisonIsFoundForEveryType) {
    verifies("SWR-SLF-008", Technique::kFaultInjection, Polarity::kViolation);

    for (const Cpu::Type type : {Cpu::Type::kWord32, Cpu::Type::kWord64, Cpu::Type::kSigned32,
                                 Cpu::Type::kSigned64, Cpu::Type::kFloat, Cpu::Type::kDouble}) {
        for (const Relation relation :
             {Relation::kNeverLess, Relation::kAlwaysLess, Relation::kNeverEqual, Relation::kAlwaysEqual}) {
            Cpu::compared = type;
            Cpu::relation = relation;
            EXPECT_TRUE(is_found()) << static_cast<int>(type) << ' ' << static_cast<int>(relation);
        }
    }
}

TEST_F(CpuCheckTest, ComparisonThatIsWrongAtTheEndsIsFoundForSignedTypes) {
    verifies("SWR-SLF-008", Technique::kFaultInjection, Polarity::kViolation);

    for (const Cpu::Type type :
         {Cpu::Type::kSigned32, Cpu::Type::kSigned64, Cpu::Type::kFloat, Cpu::Type::kDouble}) {
        for (const Relation relation :
             {Relation::kLessOrEqual, Relation::kLowestIsNotLess, Relation::kLargestIsLess}) {
            Cpu::compared = type;
            Cpu::relation = relation;
            EXPECT_TRUE(is_found()) << static_cast<int>(type) << ' ' << static_cast<int>(relation);
        }
    }
}

TEST_F(CpuCheckTest, WordsThatShareABitAndCountAsEqualAreFound) {
    verifies("SWR-SLF-008", Technique::kFaultInjection, Polarity::kViolation);
    Cpu::relation = Relation::kEqualWithCommonBit;

    for (const Cpu::Type type : {Cpu::Type::kWord32, Cpu::Type::kWord64}) {
        Cpu::compared = type;
        EXPECT_TRUE(is_found());
    }
}

TEST_F(CpuCheckTest, ComparisonThatIsBlindForOneBitIsFound) {
    verifies("SWR-SLF-008", Technique::kFaultInjection, Polarity::kViolation);
    Cpu::relation = Relation::kBlindBit;

    for (const Cpu::Type type : {Cpu::Type::kWord32, Cpu::Type::kWord64}) {
        Cpu::compared = type;
        for (Cpu::bit = 0U; Cpu::bit < (type == Cpu::Type::kWord32 ? 32U : 64U); ++Cpu::bit) {
            EXPECT_TRUE(is_found()) << Cpu::bit;
        }
    }
}

TEST_F(CpuCheckTest, StepThatIsNoneWasNotDone) {
    verifies("SWR-SLF-008", Technique::kErrorGuessing, Polarity::kViolation);
    CpuCheck<NativeCpu> sut;
    sut.begin();
    for (std::size_t step = 0U; step < sut.get_step_count(); ++step) {
        static_cast<void>(sut.step());
    }

    EXPECT_EQ(sut.step(), SelfTestStatus::kFailed);
}

TEST_F(CpuCheckTest, OperationThatIsNoneGoesToTheAssertionHandler) {
    verifies("SWR-SLF-008", Technique::kErrorGuessing, Polarity::kViolation);

    EXPECT_CHECK_FAILS(static_cast<void>(NativeCpu::calc(static_cast<ArithmeticOperation>(9), 1U, 1U)),
                       "native_cpu.hpp", 1);
    EXPECT_CHECK_FAILS(static_cast<void>(NativeCpu::calc(static_cast<WordOperation>(9), 1U, 1U)),
                       "native_cpu.hpp", 2);
}

TEST_F(CpuCheckTest, UnitInTheDeclaredModePasses) {
    verifies("SWR-SLF-009");
    ASSERT_EQ(std::fegetround(), FE_TONEAREST);

    EXPECT_EQ(run_pass<NativeCpu>(), SelfTestStatus::kPassed);
}

TEST_F(CpuCheckTest, EveryOtherRoundingModeOfTheRealUnitIsFound) {
    verifies("SWR-SLF-009", Technique::kFaultInjection, Polarity::kViolation);

    for (const int mode : {FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO}) {
        ASSERT_EQ(std::fesetround(mode), 0);
        const SelfTestStatus status = run_pass<NativeCpu>();
        ASSERT_EQ(std::fesetround(FE_TONEAREST), 0);
        EXPECT_EQ(status, SelfTestStatus::kFailed) << mode;
    }
    EXPECT_EQ(run_pass<NativeCpu>(), SelfTestStatus::kPassed);
}

TEST_F(CpuCheckTest, FlushedDenormalsAreFound) {
    verifies("SWR-SLF-009", Technique::kFaultInjection, Polarity::kViolation);

    for (const Cpu::Type type : {Cpu::Type::kFloat, Cpu::Type::kDouble}) {
        Cpu::flushed = type;
        EXPECT_TRUE(is_found()) << static_cast<int>(type);
    }
}

TEST_F(CpuCheckTest, InfinityThatSaturatesIsFound) {
    verifies("SWR-SLF-009", Technique::kFaultInjection, Polarity::kViolation);
    Cpu::does_saturate = true;

    EXPECT_TRUE(is_found());
}

TEST_F(CpuCheckTest, UnitWithoutNotANumberIsFound) {
    verifies("SWR-SLF-009", Technique::kFaultInjection, Polarity::kViolation);
    Cpu::has_nan = false;
    EXPECT_TRUE(is_found());
    Cpu::mend();
    for (const ArithmeticOperation operation :
         {ArithmeticOperation::kAdd, ArithmeticOperation::kSubtract, ArithmeticOperation::kMultiply,
          ArithmeticOperation::kDivide}) {
        Cpu::without_nan = operation;
        EXPECT_TRUE(is_found()) << static_cast<int>(operation);
    }
    Cpu::mend();

    for (const Cpu::Type type : {Cpu::Type::kFloat, Cpu::Type::kDouble}) {
        for (const Relation relation : {Relation::kNanIsEqual, Relation::kNanIsLess, Relation::kNanIsMore}) {
            Cpu::compared = type;
            Cpu::relation = relation;
            EXPECT_TRUE(is_found()) << static_cast<int>(relation);
        }
    }
}

}  // namespace
}  // namespace mamori::safety
