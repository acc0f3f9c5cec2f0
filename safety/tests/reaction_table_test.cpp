// SPDX-License-Identifier: Apache-2.0
// Goal: the worst latched fault decides, and a fault that the table forgot gets the severest reaction.
// Method: all subsets of a set of faults with each reaction, against the plain definition of "worst". The
// rows are those of system tables.
#include "mamori/safety/reaction/reaction_table.hpp"

#include <gtest/gtest.h>

#include <array>
#include <string>

#include "mamori/kernel/system/system.hpp"
#include "mamori/trace/verifies.hpp"

namespace mamori::safety {
namespace {

using namespace verification;

using literals::operator""_ms;

enum class Fault : FaultIndex { kNoise, kWarm, kSlip, kFast, kTorn, kFastAndUrgent, kSlow, kCount };

constexpr auto kSystem = system(
    frame(1_ms),
    faults<Fault::kNoise, Fault::kWarm, Fault::kSlip, Fault::kFast, Fault::kTorn, Fault::kFastAndUrgent,
           Fault::kSlow>(),
    react(Fault::kSlip, Reaction::kSs2, within(30_ms)), react(Fault::kNoise, Reaction::kNone, within(100_ms)),
    react(Fault::kTorn, Reaction::kSto, within(2_ms)), react(Fault::kWarm, Reaction::kDegrade, within(50_ms)),
    react(Fault::kFast, Reaction::kSs1, within(20_ms)),
    react(Fault::kFastAndUrgent, Reaction::kSs1, within(5_ms)),
    react(Fault::kSlow, Reaction::kSs1, within(40_ms)));
MAMORI_CHECK(kSystem);
constexpr auto& kTable = kSystem.reactions;

constexpr ReactionRow make_row(FaultIndex fault, Reaction reaction, Duration time,
                               ModeMask modes = kEveryMode) {
    return {fault, static_cast<std::uint32_t>(reaction), time, modes};
}

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
        make_row(0U, Reaction::kSs1, 50_ms),
        make_row(1U, Reaction::kDegrade, 1_ms),
    }};
    faults_.report(0U, true, Instant{1});
    faults_.report(1U, true, Instant{1});

    EXPECT_EQ(calc_reaction(kUrgentWarning, faults_).reaction, Reaction::kSs1);
    EXPECT_EQ(calc_reaction(kUrgentWarning, faults_).within, 50_ms);
}

TEST_F(ReactionTableTest, LowestFaultNumberIsNamedAmongEquals) {
    verifies("SWR-FLT-005", Technique::kBoundaryValues);
    constexpr std::array<ReactionRow, 2U> kTwins{
        {make_row(3U, Reaction::kSs1, 5_ms), make_row(2U, Reaction::kSs1, 5_ms)}};
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

TEST_F(ReactionTableTest, ANumberThatIsNoReactionCutsTheTorqueAtOnce) {
    verifies("SWR-FLT-006", Technique::kBoundaryValues, Polarity::kViolation);
    std::array<ReactionRow, 1U> rows{make_row(0U, Reaction::kSto, 7_ms)};
    latch(Fault::kNoise);
    EXPECT_EQ(calc_reaction(rows, faults_).within, 7_ms);

    ASSERT_EQ(faults_.get_capacity(), kFaultCount);
    std::array<FaultRecord, 1U> records{};
    FaultRegister fresh{records};
    fresh.report(0U, true, Instant{1});
    rows[0U].reaction = static_cast<std::uint32_t>(Reaction::kSto) + 1U;
    EXPECT_EQ(calc_reaction(rows, fresh).reaction, Reaction::kSto);
    EXPECT_EQ(calc_reaction(rows, fresh).within, Duration{0});
}

// ---- Modes
// ---------------------------------------------------------------------------------------------------

enum class Mode : std::uint8_t { kAutomatic, kManual, kService };

constexpr ModeMask kAutomatic = in_modes<Mode::kAutomatic>().mask;
constexpr ModeMask kManual = in_modes<Mode::kManual>().mask;
constexpr ModeMask kService = in_modes<Mode::kService>().mask;
static_assert(in_modes<Mode::kAutomatic, Mode::kService>().mask == 5U);

constexpr std::array<ReactionRow, 4U> kModeTable{make_row(0U, Reaction::kSs1, 10_ms, kAutomatic),
                                                 make_row(0U, Reaction::kDegrade, 20_ms, kManual | kService),
                                                 make_row(1U, Reaction::kSs2, 30_ms),
                                                 make_row(2U, Reaction::kNone, 5_ms, kService)};

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

TEST_F(ReactionTableTest, TheDemandOfAFaultIsKnownBeforeItIsLatched) {
    verifies("SWR-FLT-010");

    EXPECT_EQ(find_demand(kModeTable, 2U, 2U).reaction, Reaction::kNone);
    EXPECT_EQ(find_demand(kModeTable, 1U, 2U).within, 30_ms);
    EXPECT_EQ(find_demand(kModeTable, 2U, 0U).reaction, Reaction::kSto) << "no row";
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
        make_row(0U, Reaction::kSs1, 10_ms, kAutomatic),
        make_row(0U, Reaction::kSs1, 20_ms, kManual),
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

}  // namespace
}  // namespace mamori::safety
