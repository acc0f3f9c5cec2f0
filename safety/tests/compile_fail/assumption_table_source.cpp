// SPDX-License-Identifier: Apache-2.0
// Compiled by assumption_table_compile_test.cpp with one defect at a time; without a defect it compiles.
#include "mamori/safety/assumptions/assumption_table.hpp"

namespace {

using mamori::Duration;
using mamori::safety::assume;
using mamori::safety::AssumptionCheck;
using mamori::safety::AssumptionIndex;
using mamori::safety::AssumptionRow;
using mamori::safety::SelfTestStatus;

enum class Assumption : AssumptionIndex { kTickSource, kWatchdog, kBudget, kCount };

class Check final : public AssumptionCheck {
  public:
    SelfTestStatus check() noexcept override { return SelfTestStatus::kPassed; }
};

Check g_check;
constexpr Duration kSoon{1000000};
constexpr std::array kAssumptions{
    assume(Assumption::kTickSource, "tick source", g_check, kSoon),
    assume(Assumption::kWatchdog, "watchdog", g_check, kSoon),
#ifndef MAMORI_DEFECT_MISSING_ROW
    assume(Assumption::kBudget, "budget", g_check, kSoon),
#endif
#ifdef MAMORI_DEFECT_DOUBLE_ROW
    assume(Assumption::kTickSource, "tick source again", g_check, kSoon),
#endif
#ifdef MAMORI_DEFECT_UNKNOWN
    assume(Assumption::kCount, "unknown", g_check, kSoon),
#endif
#ifdef MAMORI_DEFECT_NO_CHECK
    AssumptionRow{0U, "nothing", nullptr, kSoon},
#endif
#ifdef MAMORI_DEFECT_NO_TIME
    assume(Assumption::kTickSource, "never", g_check, Duration{0}),
#endif
};

static_assert(mamori::safety::checks_all<kAssumptions, Assumption::kCount>());

}  // namespace
