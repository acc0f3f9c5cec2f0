// SPDX-License-Identifier: Apache-2.0
// Goal: the worst latched fault decides, and a fault that the table forgot gets the severest reaction.
// Method: all subsets of a set of faults with each reaction, against the plain definition of "worst".
#include "mamori/safety/reaction/reaction_table.hpp"

#include <string>

#include "mamori/trace/verifies.hpp"

namespace mamori::safety {
namespace {

using namespace verification;

using literals::operator""_ms;

enum class Fault : FaultIndex { kNoise, kWarm, kSlip, kFast, kTorn, kFastAndUrgent, kSlow, kCount };

constexpr std::array<ReactionRow, 7U> kTable{{
    react(Fault::kSlip, Reaction::kSs2, 30_ms),
    react(Fault::kNoise, Reaction::kNone, 100_ms),
    react(Fault::kTorn, Reaction::kSto, 2_ms),
    react(Fault::kWarm, Reaction::kDegrade, 50_ms),
    react(Fault::kFast, Reaction::kSs1, 20_ms),
    react(Fault::kFastAndUrgent, Reaction::kSs1, 5_ms),
    react(Fault::kSlow, Reaction::kSs1, 40_ms),
}};
static_assert(covers_all<kTable, Fault::kCount>());

constexpr FaultIndex kFaultCount = static_cast<FaultIndex>(Fault::kCount);

class ReactionTableTest : public ::testing::Test {
  protected:
    void latch(Fault fault) { faults_.report(static_cast<FaultIndex>(fault), true, Instant{1}); }

    std::array<FaultRecord, kFaultCount> records_{};
    FaultRegister faults_{records_};
};

TEST_F(ReactionTableTest, NoFaultDemandsNothing) {
    verifies("SWR-FLT-005");

    EXPECT_EQ(calc_reaction(kTable, faults_).reaction, Reaction::kNone);
    EXPECT_EQ(calc_reaction(kTable, faults_).fault, kNoFault);
    EXPECT_EQ(calc_reaction(kTable, faults_).within, Duration{0});
}

TEST_F(ReactionTableTest, SingleFaultGetsItsRow) {
    verifies("SWR-FLT-005");
    latch(Fault::kWarm);

    const ReactionDemand demand = calc_reaction(kTable, faults_);
    EXPECT_EQ(demand.reaction, Reaction::kDegrade);
    EXPECT_EQ(demand.fault, static_cast<FaultIndex>(Fault::kWarm));
    EXPECT_EQ(demand.within, 50_ms);
}

TEST_F(ReactionTableTest, WorstOfEverySubsetOfFaultsDecides) {
    verifies("SWR-FLT-005", Technique::kEquivalenceClasses, Polarity::kViolation);
    // By fault number, written down again: what each fault asks for.
    constexpr std::array<Reaction, kFaultCount> kWanted{Reaction::kNone, Reaction::kDegrade, Reaction::kSs2,
                                                        Reaction::kSs1,  Reaction::kSto,     Reaction::kSs1,
                                                        Reaction::kSs1};

    for (unsigned subset = 0U; subset < (1U << kFaultCount); ++subset) {
        std::array<FaultRecord, kFaultCount> records{};
        FaultRegister faults{records};
        Reaction worst = Reaction::kNone;
        for (FaultIndex fault = 0U; fault < kFaultCount; ++fault) {
            const bool is_present = ((subset >> fault) & 1U) != 0U;
            faults.report(fault, is_present, Instant{1});
            worst = is_present && kWanted[fault] > worst ? kWanted[fault] : worst;
        }
        ASSERT_EQ(calc_reaction(kTable, faults).reaction, worst) << "subset " << subset;
    }
}

TEST_F(ReactionTableTest, ShortestTimeDecidesAmongEquallySevereFaults) {
    verifies("SWR-FLT-005", Technique::kBoundaryValues, Polarity::kViolation);
    latch(Fault::kFast);
    ASSERT_EQ(calc_reaction(kTable, faults_).within, 20_ms);

    latch(Fault::kFastAndUrgent);
    EXPECT_EQ(calc_reaction(kTable, faults_).within, 5_ms);
    latch(Fault::kSlow);
    latch(Fault::kWarm);
    EXPECT_EQ(calc_reaction(kTable, faults_).within, 5_ms);
    EXPECT_EQ(calc_reaction(kTable, faults_).fault, static_cast<FaultIndex>(Fault::kFastAndUrgent));
}

TEST_F(ReactionTableTest, LesserReactionWithLessTimeDoesNotDecide) {
    verifies("SWR-FLT-005", Technique::kErrorGuessing, Polarity::kViolation);
    constexpr std::array<ReactionRow, 2U> kUrgentWarning{{
        {0U, Reaction::kSs1, 50_ms},
        {1U, Reaction::kDegrade, 1_ms},
    }};
    faults_.report(0U, true, Instant{1});
    faults_.report(1U, true, Instant{1});

    EXPECT_EQ(calc_reaction(kUrgentWarning, faults_).reaction, Reaction::kSs1);
    EXPECT_EQ(calc_reaction(kUrgentWarning, faults_).within, 50_ms);
}

TEST_F(ReactionTableTest, LowestFaultNumberIsNamedAmongEquals) {
    verifies("SWR-FLT-005", Technique::kBoundaryValues);
    constexpr std::array<ReactionRow, 2U> kTwins{{{3U, Reaction::kSs1, 5_ms}, {2U, Reaction::kSs1, 5_ms}}};
    faults_.report(3U, true, Instant{1});
    faults_.report(2U, true, Instant{2});

    EXPECT_EQ(calc_reaction(kTwins, faults_).fault, 2U);
}

TEST_F(ReactionTableTest, ReactionStaysUntilTheFaultIsAcknowledged) {
    verifies("SWR-FLT-005", Technique::kFaultInjection, Polarity::kViolation);
    latch(Fault::kTorn);
    faults_.report(static_cast<FaultIndex>(Fault::kTorn), false, Instant{2});

    EXPECT_EQ(calc_reaction(kTable, faults_).reaction, Reaction::kSto);
    ASSERT_EQ(faults_.acknowledge_all(), Status::kOk);
    EXPECT_EQ(calc_reaction(kTable, faults_).reaction, Reaction::kNone);
}

TEST_F(ReactionTableTest, FaultInTheTableIsNotAnsweredMoreSeverelyThanDeclared) {
    verifies("SWR-FLT-006");
    latch(Fault::kSlip);

    EXPECT_EQ(calc_reaction(kTable, faults_).reaction, Reaction::kSs2);
}

TEST_F(ReactionTableTest, LatchedFaultWithoutARowCutsTheTorqueAtOnce) {
    verifies("SWR-FLT-006", Technique::kFaultInjection, Polarity::kViolation);
    latch(Fault::kNoise);
    const Span<const ReactionRow> table_of_others{kTable.data(), 1U};

    const ReactionDemand demand = calc_reaction(table_of_others, faults_);
    EXPECT_EQ(demand.reaction, Reaction::kSto);
    EXPECT_EQ(demand.fault, static_cast<FaultIndex>(Fault::kNoise));
    EXPECT_EQ(demand.within, Duration{0});
}

TEST_F(ReactionTableTest, SeverityRisesFromNoneToSto) {
    verifies("SWR-FLT-005", Technique::kInterface);

    EXPECT_LT(Reaction::kNone, Reaction::kDegrade);
    EXPECT_LT(Reaction::kDegrade, Reaction::kSs2);
    EXPECT_LT(Reaction::kSs2, Reaction::kSs1);
    EXPECT_LT(Reaction::kSs1, Reaction::kSto);
    EXPECT_EQ(std::string(get_name(Reaction::kNone)), "None");
    EXPECT_EQ(std::string(get_name(Reaction::kDegrade)), "Degrade");
    EXPECT_EQ(std::string(get_name(Reaction::kSs2)), "Ss2");
    EXPECT_EQ(std::string(get_name(Reaction::kSs1)), "Ss1");
    EXPECT_EQ(std::string(get_name(Reaction::kSto)), "Sto");
    EXPECT_EQ(std::string(get_name(static_cast<Reaction>(99))), "Invalid");
}

TEST_F(ReactionTableTest, RowOfAnUnknownFaultOrWithoutTimeIsInvalid) {
    verifies("SWR-FLT-004", Technique::kBoundaryValues, Polarity::kViolation);
    std::array<ReactionRow, 2U> table{react(Fault::kNoise, Reaction::kSto, 1_ms),
                                      react(Fault::kWarm, Reaction::kSto, Duration{1})};

    EXPECT_TRUE(are_rows_valid(table, 2U));
    EXPECT_FALSE(are_rows_valid(table, 1U)) << "fault 1 of one fault";
    table[1U].within = Duration{0};
    EXPECT_FALSE(are_rows_valid(table, 2U));
}

TEST_F(ReactionTableTest, RowsOfAFaultAreCounted) {
    verifies("SWR-FLT-004", Technique::kEquivalenceClasses);
    const auto twice = react(Fault::kWarm, Reaction::kSto, 1_ms);
    const std::array<ReactionRow, 3U> table{react(Fault::kNoise, Reaction::kSto, 1_ms), twice, twice};

    EXPECT_EQ(count_rows(table, static_cast<FaultIndex>(Fault::kNoise)), 1U);
    EXPECT_EQ(count_rows(table, static_cast<FaultIndex>(Fault::kWarm)), 2U);
    EXPECT_EQ(count_rows(table, static_cast<FaultIndex>(Fault::kSlip)), 0U);
    EXPECT_TRUE((covers_all<kTable, Fault::kCount>()));
}

// ---- Modes
// ---------------------------------------------------------------------------------------------------

enum class Mode : std::uint8_t { kAutomatic, kManual, kService, kCount };

constexpr std::array<ReactionRow, 4U> kModeTable{{
    react_in(to_modes(Mode::kAutomatic), Fault::kNoise, Reaction::kSs1, 10_ms),
    react_in(to_modes(Mode::kManual, Mode::kService), Fault::kNoise, Reaction::kDegrade, 20_ms),
    react(Fault::kWarm, Reaction::kSs2, 30_ms),
    react_in(to_modes(Mode::kService), Fault::kSlip, Reaction::kNone, 5_ms),
}};
static_assert(to_modes(Mode::kAutomatic, Mode::kService) == 5U && to_modes() == 0U);

Reaction calc_in(Mode mode, FaultRegister& faults) {
    return calc_reaction(kModeTable, faults, static_cast<std::size_t>(mode)).reaction;
}

/// Demand for one fault that is latched in `mode`, in no other mode before.
Reaction calc_first_in(Mode mode, Fault fault) {
    std::array<FaultRecord, kFaultCount> records{};
    FaultRegister faults{records};
    faults.report(static_cast<FaultIndex>(fault), true, Instant{1});
    return calc_in(mode, faults);
}

TEST_F(ReactionTableTest, ModeDecidesWhichRowAnswers) {
    verifies("SWR-FLT-010");

    EXPECT_EQ(calc_first_in(Mode::kAutomatic, Fault::kNoise), Reaction::kSs1);
    EXPECT_EQ(calc_first_in(Mode::kManual, Fault::kNoise), Reaction::kDegrade);
    EXPECT_EQ(calc_first_in(Mode::kService, Fault::kNoise), Reaction::kDegrade);
    latch(Fault::kNoise);
    EXPECT_EQ(calc_in(Mode::kManual, faults_), Reaction::kDegrade);
    latch(Fault::kWarm);
    EXPECT_EQ(calc_in(Mode::kManual, faults_), Reaction::kSs2) << "the worst of all latched faults";
    EXPECT_EQ(calc_reaction(kModeTable, faults_).reaction, Reaction::kSs1)
        << "mode 0 unless another is named";
}

TEST_F(ReactionTableTest, FaultWithoutARowForTheModeCutsTheTorque) {
    verifies("SWR-FLT-010", Technique::kFaultInjection, Polarity::kViolation);
    latch(Fault::kSlip);

    EXPECT_EQ(calc_in(Mode::kService, faults_), Reaction::kNone);
    EXPECT_EQ(calc_in(Mode::kAutomatic, faults_), Reaction::kSto);
    EXPECT_EQ(calc_first_in(Mode::kManual, Fault::kSlip), Reaction::kSto);
}

TEST_F(ReactionTableTest, ModeThatCannotBeCutsTheTorqueForEveryFault) {
    verifies("SWR-FLT-010", Technique::kBoundaryValues, Polarity::kViolation);
    latch(Fault::kWarm);

    EXPECT_EQ(calc_reaction(kModeTable, faults_, kSystemModeMax - 1U).reaction, Reaction::kSs2);
    EXPECT_EQ(calc_reaction(kModeTable, faults_, kSystemModeMax).reaction, Reaction::kSto);
    EXPECT_EQ(calc_first_in(static_cast<Mode>(255), Fault::kWarm), Reaction::kSto);
}

TEST_F(ReactionTableTest, ModeSwitchDoesNotLowerTheDemandOfALatchedFault) {
    verifies("SWR-FLT-012", Technique::kStateTransition, Polarity::kViolation);
    latch(Fault::kNoise);
    ASSERT_EQ(calc_in(Mode::kAutomatic, faults_), Reaction::kSs1);

    const ReactionDemand demand = calc_reaction(kModeTable, faults_, 1U);
    EXPECT_EQ(demand.reaction, Reaction::kSs1);
    EXPECT_EQ(demand.within, 10_ms);
    EXPECT_EQ(demand.fault, static_cast<FaultIndex>(Fault::kNoise));
    latch(Fault::kWarm);
    EXPECT_EQ(calc_in(Mode::kManual, faults_), Reaction::kSs1) << "a lesser fault hides nothing";
}

TEST_F(ReactionTableTest, ModeSwitchRaisesTheDemandOfALatchedFault) {
    verifies("SWR-FLT-012", Technique::kStateTransition, Polarity::kViolation);
    latch(Fault::kNoise);
    ASSERT_EQ(calc_in(Mode::kManual, faults_), Reaction::kDegrade);

    EXPECT_EQ(calc_in(Mode::kAutomatic, faults_), Reaction::kSs1);
    EXPECT_EQ(calc_in(Mode::kManual, faults_), Reaction::kSs1);
}

TEST_F(ReactionTableTest, ShorterTimeOfEquallySevereModesIsKept) {
    verifies("SWR-FLT-012", Technique::kBoundaryValues, Polarity::kViolation);
    constexpr std::array<ReactionRow, 2U> kTimes{{
        react_in(to_modes(Mode::kAutomatic), Fault::kNoise, Reaction::kSs1, 10_ms),
        react_in(to_modes(Mode::kManual), Fault::kNoise, Reaction::kSs1, 20_ms),
    }};
    latch(Fault::kNoise);
    ASSERT_EQ(calc_reaction(kTimes, faults_, 1U).within, 20_ms);

    EXPECT_EQ(calc_reaction(kTimes, faults_, 0U).within, 10_ms);
    EXPECT_EQ(calc_reaction(kTimes, faults_, 1U).within, 10_ms);
}

TEST_F(ReactionTableTest, DemandOfAnInvalidModeStaysInTheNextValidOne) {
    verifies("SWR-FLT-012", Technique::kFaultInjection, Polarity::kViolation);
    latch(Fault::kWarm);
    ASSERT_EQ(calc_reaction(kModeTable, faults_, kSystemModeMax).reaction, Reaction::kSto);

    EXPECT_EQ(calc_in(Mode::kManual, faults_), Reaction::kSto);
}

TEST_F(ReactionTableTest, FaultThatIsNotLatchedKeepsNoDemand) {
    verifies("SWR-FLT-012", Technique::kEquivalenceClasses, Polarity::kViolation);
    const ReactionDemand demand{Reaction::kSto, static_cast<FaultIndex>(Fault::kWarm), 1_ms};

    EXPECT_EQ(faults_.raise(demand).fault, kNoFault);
    latch(Fault::kWarm);
    EXPECT_EQ(calc_in(Mode::kManual, faults_), Reaction::kSs2) << "nothing of the earlier demand";
    EXPECT_EQ(faults_.raise(demand).reaction, Reaction::kSto);
    EXPECT_EQ(calc_in(Mode::kManual, faults_), Reaction::kSto);
}

TEST_F(ReactionTableTest, AcknowledgementEndsTheDemandAndALaterFaultGetsTheRowOfItsMode) {
    verifies("SWR-FLT-012", Technique::kStateTransition);
    latch(Fault::kNoise);
    ASSERT_EQ(calc_in(Mode::kAutomatic, faults_), Reaction::kSs1);
    faults_.report(static_cast<FaultIndex>(Fault::kNoise), false, Instant{2});
    ASSERT_EQ(faults_.acknowledge_all(), Status::kOk);
    EXPECT_EQ(calc_in(Mode::kManual, faults_), Reaction::kNone);

    latch(Fault::kNoise);
    EXPECT_EQ(calc_in(Mode::kManual, faults_), Reaction::kDegrade);
}

TEST_F(ReactionTableTest, RowWithoutAModeOrWithAnUnknownOneIsInvalid) {
    verifies("SWR-FLT-010", Technique::kBoundaryValues, Polarity::kViolation);
    std::array<ReactionRow, 1U> table{};
    table[0U] = react_in(to_modes(Mode::kService), Fault::kNoise, Reaction::kSto, 1_ms);

    EXPECT_TRUE(are_rows_valid(table, 1U, 3U));
    EXPECT_FALSE(are_rows_valid(table, 1U, 2U)) << "mode 2 of two modes";
    table[0U].modes = ModeMask{1U} << 31U;
    EXPECT_TRUE(are_rows_valid(table, 1U, 32U));
    EXPECT_FALSE(are_rows_valid(table, 1U, 31U));
    table[0U].modes = 0U;
    EXPECT_FALSE(are_rows_valid(table, 1U, 3U));
    table[0U].modes = kEveryMode;
    EXPECT_TRUE(are_rows_valid(table, 1U, 1U));
}

}  // namespace
}  // namespace mamori::safety
