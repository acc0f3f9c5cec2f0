// SPDX-License-Identifier: Apache-2.0
// Compiled by reaction_table_compile_test.cpp with one defect at a time; without a defect it compiles.
#include "mamori/safety/reaction/reaction_table.hpp"

namespace {

using mamori::Duration;
using mamori::safety::FaultIndex;
using mamori::safety::react;
using mamori::safety::Reaction;
using mamori::safety::ReactionRow;

enum class Fault : FaultIndex { kOverspeed, kEncoderDiscrepancy, kTorqueRunaway, kCount };

constexpr Duration kSoon{1000000};
constexpr std::array kReactions{
    react(Fault::kOverspeed, Reaction::kSs1, kSoon),
    react(Fault::kEncoderDiscrepancy, Reaction::kSs1, kSoon),
#ifndef MAMORI_DEFECT_MISSING_ROW
    react(Fault::kTorqueRunaway, Reaction::kSto, kSoon),
#endif
#ifdef MAMORI_DEFECT_DOUBLE_ROW
    react(Fault::kOverspeed, Reaction::kNone, kSoon),
#endif
#ifdef MAMORI_DEFECT_UNKNOWN_FAULT
    react(Fault::kCount, Reaction::kSto, kSoon),
#endif
#ifdef MAMORI_DEFECT_NO_TIME
    ReactionRow{0U, Reaction::kSto, Duration{0}},
#endif
};

static_assert(mamori::safety::covers_all<kReactions, Fault::kCount>());

enum class Mode : unsigned char { kAutomatic, kManual, kCount };

constexpr std::array kModeReactions{
    mamori::safety::react_in(mamori::safety::to_modes(Mode::kAutomatic), Fault::kOverspeed, Reaction::kSs1,
                             kSoon),
#ifndef MAMORI_DEFECT_MODE_WITHOUT_ROW
    mamori::safety::react_in(mamori::safety::to_modes(Mode::kManual), Fault::kOverspeed, Reaction::kSto,
                             kSoon),
#endif
#ifdef MAMORI_DEFECT_MODE_WITH_TWO_ROWS
    react(Fault::kOverspeed, Reaction::kSto, kSoon),
#endif
#ifdef MAMORI_DEFECT_UNKNOWN_MODE
    mamori::safety::react_in(mamori::safety::to_modes(Mode::kCount), Fault::kOverspeed, Reaction::kSto,
                             kSoon),
#endif
    react(Fault::kEncoderDiscrepancy, Reaction::kSs1, kSoon),
    react(Fault::kTorqueRunaway, Reaction::kSto, kSoon),
};

static_assert(mamori::safety::covers_all<kModeReactions, Fault::kCount, Mode::kCount>());

}  // namespace
