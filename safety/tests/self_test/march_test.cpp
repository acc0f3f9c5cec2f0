// SPDX-License-Identifier: Apache-2.0
// Goal: the march tests find every fault that March C- is known to find, in steps of bounded cost, and live
// data survive. Method: every fault of a model, at every bit and every pair of bits of a small memory;
// accesses are counted.
#include "mamori/safety/self_test/march.hpp"

#include <algorithm>
#include <array>
#include <random>
#include <vector>

#include "faulty_sram.hpp"
#include "mamori/safety/self_test/ram_area.hpp"
#include "mamori/trace/verifies.hpp"
#include "mamori/verification/failed_check.hpp"

namespace mamori::safety {
namespace {

using namespace verification;

constexpr std::size_t kWords = 6U;
constexpr std::size_t kBits = kWords * FaultySram::kBits;

SelfTestStatus run_pass(SelfTest& test) {
    test.begin();
    SelfTestStatus status = SelfTestStatus::kRunning;
    for (std::size_t i = 0U; i < test.get_step_count() && status == SelfTestStatus::kRunning; ++i) {
        status = test.step();
    }
    return status;
}

bool finds(const MemoryFault& fault, std::size_t visits_per_step = 1000U) {
    FaultySram memory(kWords, fault);
    RamMarch<FaultySram> sut(memory, visits_per_step);
    return run_pass(sut) == SelfTestStatus::kFailed;
}

/// All faults between two different bits of the memory.
std::vector<MemoryFault> make_coupling_faults(std::size_t bits) {
    std::vector<MemoryFault> faults;
    for (std::size_t aggressor = 0U; aggressor < bits; ++aggressor) {
        for (std::size_t victim = 0U; victim < bits; ++victim) {
            for (unsigned int form = 0U; aggressor != victim && form < 4U; ++form) {
                const bool trigger = (form & 1U) != 0U;
                const bool value = (form & 2U) != 0U;
                faults.push_back({FaultKind::kCouplingIdempotent, aggressor, victim, trigger, value});
                faults.push_back({FaultKind::kCouplingState, aggressor, victim, trigger, value});
                faults.push_back({FaultKind::kCouplingInversion, aggressor, victim, trigger, value});
            }
        }
    }
    return faults;
}

TEST(RamMarchTest, SoundMemoryPassesAgainAndAgain) {
    verifies("SWR-SLF-005");
    FaultySram memory(kWords);
    RamMarch<FaultySram> sut(memory, 7U);

    EXPECT_EQ(run_pass(sut), SelfTestStatus::kPassed);
    EXPECT_EQ(run_pass(sut), SelfTestStatus::kPassed);
}

TEST(RamMarchTest, RealMemoryPasses) {
    verifies("SWR-SLF-005", Technique::kInterface);
    std::array<std::uint32_t, 32U> words{};
    RamArea area(words.data(), words.size());
    RamMarch<RamArea> sut(area, 100U);

    EXPECT_EQ(sut.get_step_count(), (32U * 6U * 6U + 99U) / 100U);
    EXPECT_EQ(run_pass(sut), SelfTestStatus::kPassed);
    EXPECT_EQ(words[0], 0x0000FFFFU) << "the last background";
}

TEST(RamMarchTest, AnyTwoBitsOfAWordDifferInOneBackground) {
    verifies("SWR-SLF-005", Technique::kRequirementsBased);
    std::array<std::uint32_t, 6U> backgrounds{};
    backgrounds = detail::make_backgrounds<std::uint32_t>();
    ASSERT_EQ(detail::calc_background_count<std::uint8_t>(), 4U);
    ASSERT_EQ(detail::make_background<std::uint8_t>(0U), 0x00U);
    ASSERT_EQ(detail::make_background<std::uint8_t>(3U), 0x0FU);

    for (unsigned int a = 0U; a < 32U; ++a) {
        for (unsigned int b = 0U; b < a; ++b) {
            EXPECT_TRUE(
                std::any_of(backgrounds.begin(), backgrounds.end(),
                            [a, b](std::uint32_t word) { return ((word >> a) & 1U) != ((word >> b) & 1U); }))
                << a << ' ' << b;
        }
    }
}

TEST(RamMarchTest, TakesTenAccessesPerWordAndBackground) {
    verifies("SWR-SLF-005", Technique::kRequirementsBased);
    constexpr std::size_t kBackgrounds = 4U;  // 00, 55, 33, 0F for eight bits
    FaultySram memory(kWords);
    RamMarch<FaultySram> sut(memory, 1000U);

    ASSERT_EQ(run_pass(sut), SelfTestStatus::kPassed);
    EXPECT_EQ(memory.reads_ + memory.writes_, 10U * kWords * kBackgrounds);
    EXPECT_EQ(memory.reads_, 5U * kWords * kBackgrounds);
}

TEST(RamMarchTest, StepVisitsNoMoreWordsThanDeclared) {
    verifies("SWR-SLF-005", Technique::kBoundaryValues);
    constexpr std::size_t kVisits = kWords * 6U * 4U;

    for (const std::size_t per_step :
         {std::size_t{1U}, std::size_t{5U}, kVisits - 1U, kVisits, kVisits + 1U}) {
        FaultySram memory(kWords);
        RamMarch<FaultySram> sut(memory, per_step);
        sut.begin();
        std::size_t steps = 0U;
        SelfTestStatus status = SelfTestStatus::kRunning;
        while (status == SelfTestStatus::kRunning) {
            memory.reads_ = 0U;
            status = sut.step();
            ++steps;
            ASSERT_LE(memory.reads_, per_step);
        }
        EXPECT_EQ(status, SelfTestStatus::kPassed);
        EXPECT_EQ(steps, (kVisits + per_step - 1U) / per_step);
        EXPECT_EQ(steps, sut.get_step_count());
    }
}

TEST(RamMarchTest, EveryStuckBitAndEveryMissingTransitionIsFound) {
    verifies("SWR-SLF-005", Technique::kFaultInjection, Polarity::kViolation);

    for (std::size_t bit = 0U; bit < kBits; ++bit) {
        for (const bool value : {false, true}) {
            EXPECT_TRUE(finds({FaultKind::kStuckAt, 0U, bit, false, value})) << bit << value;
            EXPECT_TRUE(finds({FaultKind::kStuckAt, 0U, bit, false, value}, 1U)) << bit << value;
            EXPECT_TRUE(finds({FaultKind::kTransition, 0U, bit, false, value})) << bit << value;
        }
    }
}

TEST(RamMarchTest, EveryCouplingOfAnyTwoBitsIsFound) {
    verifies("SWR-SLF-005", Technique::kFaultInjection, Polarity::kViolation);
    const std::vector<MemoryFault> faults = make_coupling_faults(kBits);
    ASSERT_EQ(faults.size(), kBits * (kBits - 1U) * 12U);

    const auto missed = std::count_if(faults.begin(), faults.end(), [](const auto& f) { return !finds(f); });
    EXPECT_EQ(missed, 0);
}

TEST(RamMarchTest, EveryFaultOfAnAddressIsFound) {
    verifies("SWR-SLF-005", Technique::kFaultInjection, Polarity::kViolation);

    for (std::size_t address = 0U; address < kWords; ++address) {
        for (const bool value : {false, true}) {
            EXPECT_TRUE(finds({FaultKind::kNoCell, address, 0U, false, value})) << address;
            for (std::size_t other = 0U; other < kWords; ++other) {
                if (other != address) {
                    EXPECT_TRUE(finds({FaultKind::kOtherCell, address, other, false, value}));
                    EXPECT_TRUE(finds({FaultKind::kSecondCell, address, other, false, value}));
                }
            }
        }
    }
}

TEST(RamMarchTest, BitThatARightReadDestroysIsNotClaimedInTheLastElement) {
    verifies("SWR-SLF-005", Technique::kFaultInjection, Polarity::kViolation);

    EXPECT_FALSE(finds({FaultKind::kDeceptiveRead, 0U, 3U, false, false})) << "stated in the design note";
}

TEST(RamMarchTest, StepsOfNothingGoToTheAssertionHandler) {
    verifies("SWR-SLF-005", Technique::kBoundaryValues, Polarity::kViolation);
    FaultySram memory(kWords);

    // march.hpp has two checks 1: one here, one in the class TransparentMarch.
    EXPECT_CHECK_FAILS((RamMarch<FaultySram>{memory, 0U}), "march.hpp", 1);
}

TEST(RamAreaTest, AccessOutsideTheAreaGoesToTheAssertionHandler) {
    verifies("SWR-SLF-005", Technique::kBoundaryValues, Polarity::kViolation);
    std::array<std::uint32_t, 2U> words{{7U, 8U}};
    RamArea area(words.data(), words.size());
    area.write(1U, 9U);
    EXPECT_EQ(area.read(0U), 7U);
    EXPECT_EQ(area.read(1U), 9U);
    EXPECT_EQ((RamArea{words.data(), 1U}).read(0U), 7U);

    EXPECT_CHECK_FAILS(static_cast<void>(area.read(2U)), "ram_area.hpp", 2);
    EXPECT_CHECK_FAILS(area.write(2U, 0U), "ram_area.hpp", 3);
    EXPECT_CHECK_FAILS((RamArea{nullptr, 1U}), "ram_area.hpp", 1);
    EXPECT_CHECK_FAILS((RamArea{words.data(), 0U}), "ram_area.hpp", 1);
}

using Transparent = TransparentMarch<FaultySram, 4U>;

TEST(TransparentMarchTest, LiveDataAreAsTheyWereAfterEveryStep) {
    verifies("SWR-SLF-006");
    std::mt19937 random(1U);

    for (std::size_t words = 4U; words <= 13U; ++words) {
        FaultySram memory(words);
        for (auto& cell : memory.cells_) {
            cell = static_cast<FaultySram::Word>(random());
        }
        const std::vector<FaultySram::Word> before = memory.cells_;
        Transparent sut(memory);
        sut.begin();
        for (std::size_t step = 1U; step <= sut.get_step_count(); ++step) {
            const bool is_last = step == sut.get_step_count();
            ASSERT_EQ(sut.step(), is_last ? SelfTestStatus::kPassed : SelfTestStatus::kRunning);
            ASSERT_EQ(memory.cells_, before) << words << " words, step " << step;
        }
        EXPECT_EQ(run_pass(sut), SelfTestStatus::kPassed);
    }
}

TEST(TransparentMarchTest, ObjectsOfAnyTypeSurviveInRealMemory) {
    verifies("SWR-SLF-006", Technique::kInterface);
    std::array<double, 16U> live{};
    for (std::size_t i = 0U; i < live.size(); ++i) {
        live[i] = 0.1 * static_cast<double>(i);
    }
    RamArea area(live.data(), sizeof live / sizeof(RamArea::Word));
    TransparentMarch<RamArea, 16U> sut(area);

    EXPECT_EQ(run_pass(sut), SelfTestStatus::kPassed);
    for (std::size_t i = 0U; i < live.size(); ++i) {
        EXPECT_EQ(live[i], 0.1 * static_cast<double>(i));
    }
}

TEST(TransparentMarchTest, StepTouchesItsBlockOnlyAndEveryWordHasItsTurn) {
    verifies("SWR-SLF-006", Technique::kBoundaryValues);
    FaultySram memory(9U);
    Transparent sut(memory);
    ASSERT_EQ(sut.get_step_count(), 4U * 4U) << "blocks at 0, 2, 4 and 5, under four backgrounds";
    sut.begin();

    for (std::size_t step = 0U; step < sut.get_step_count(); ++step) {
        constexpr std::array<std::size_t, 4U> kFirst{0U, 2U, 4U, 5U};
        memory.touched_.clear();
        static_cast<void>(sut.step());
        const auto [low, high] = std::minmax_element(memory.touched_.begin(), memory.touched_.end());
        EXPECT_EQ(*low, kFirst[step / 4U]);
        EXPECT_EQ(*high, kFirst[step / 4U] + 3U);
        EXPECT_EQ(memory.touched_.size(), 4U * (10U + 3U)) << "March C-, and save, restore and look";
    }
}

TEST(TransparentMarchTest, EveryFaultInsideOneWordAndBetweenNeighboursIsFound) {
    verifies("SWR-SLF-006", Technique::kFaultInjection, Polarity::kViolation);
    constexpr std::size_t kLiveWords = 9U;
    const auto misses = [](const MemoryFault& fault) {
        FaultySram memory(kLiveWords, fault);
        Transparent sut(memory);
        return run_pass(sut) != SelfTestStatus::kFailed;
    };
    std::size_t tried = 0U;

    for (const MemoryFault& fault : make_coupling_faults(kLiveWords * FaultySram::kBits)) {
        const std::size_t a = fault.aggressor / FaultySram::kBits;
        const std::size_t b = fault.victim / FaultySram::kBits;
        if (std::max(a, b) - std::min(a, b) <= 2U) {  // half a block
            ++tried;
            ASSERT_FALSE(misses(fault)) << fault.aggressor << " to " << fault.victim;
        }
    }
    for (std::size_t bit = 0U; bit < kLiveWords * FaultySram::kBits; ++bit) {
        for (const bool value : {false, true}) {
            ASSERT_FALSE(misses({FaultKind::kStuckAt, 0U, bit, false, value})) << bit;
            ASSERT_FALSE(misses({FaultKind::kTransition, 0U, bit, false, value})) << bit;
        }
    }
    EXPECT_GT(tried, 20000U);
}

TEST(TransparentMarchTest, SoundWordsArePutBackAlsoWhenAFaultIsFound) {
    verifies("SWR-SLF-006", Technique::kFaultInjection, Polarity::kViolation);
    FaultySram memory(4U, {FaultKind::kStuckAt, 0U, 8U, false, true});  // bit 0 of word 1, which holds a 1
    Transparent sut(memory);

    EXPECT_EQ(run_pass(sut), SelfTestStatus::kFailed);
    EXPECT_EQ(memory.cells_, (std::vector<FaultySram::Word>(4U, 0xA5U)));
}

/// Memory that takes no write any more after so many of them.
struct FadingMemory {
    using Word = std::uint8_t;
    std::size_t size() const { return cells.size(); }
    Word read(std::size_t index) const { return cells[index]; }
    void write(std::size_t index, Word value) {
        if (writes_left > 0U) {
            --writes_left;
            cells[index] = value;
        }
    }
    std::array<Word, 4U> cells{{1U, 2U, 3U, 4U}};
    std::size_t writes_left;
};

TEST(TransparentMarchTest, WordThatDoesNotTakeItsContentsBackIsFound) {
    verifies("SWR-SLF-006", Technique::kFaultInjection, Polarity::kViolation);
    constexpr std::size_t kStepWrites = 4U * (5U + 1U);               // March C- and restore
    constexpr std::size_t kMarchWrites = 3U * kStepWrites + 4U * 5U;  // up to the last restore

    for (const std::size_t restored : {0U, 3U, 4U}) {
        FadingMemory memory{{{1U, 2U, 3U, 4U}}, kMarchWrites + restored};
        TransparentMarch<FadingMemory, 4U> sut(memory);
        EXPECT_EQ(run_pass(sut), restored == 4U ? SelfTestStatus::kPassed : SelfTestStatus::kFailed)
            << restored;
    }
}

/// Memory that loses one write.
struct ForgetfulMemory {
    using Word = std::uint8_t;
    std::size_t size() const { return cells.size(); }
    Word read(std::size_t index) const { return cells[index]; }
    void write(std::size_t index, Word value) {
        cells[index] = writes == lost ? cells[index] : value;
        ++writes;
    }
    std::array<Word, 4U> cells{{1U, 2U, 3U, 4U}};
    std::size_t lost;
    std::size_t writes{0U};
};

TEST(TransparentMarchTest, EachSingleWordThatDoesNotTakeItsContentsBackIsFound) {
    verifies("SWR-SLF-006", Technique::kFaultInjection, Polarity::kViolation);
    constexpr std::size_t kFirstRestore = 3U * 4U * 6U + 4U * 5U;  // of the last step

    for (std::size_t word = 0U; word < 4U; ++word) {
        ForgetfulMemory memory{{{1U, 2U, 3U, 4U}}, kFirstRestore + word};
        TransparentMarch<ForgetfulMemory, 4U> sut(memory);
        EXPECT_EQ(run_pass(sut), SelfTestStatus::kFailed) << word;
    }
}

TEST(TransparentMarchTest, AreaSmallerThanABlockGoesToTheAssertionHandler) {
    verifies("SWR-SLF-006", Technique::kBoundaryValues, Polarity::kViolation);
    FaultySram memory(3U);

    EXPECT_CHECK_FAILS(Transparent{memory}, "march.hpp", 1);
}

}  // namespace
}  // namespace mamori::safety
