// SPDX-License-Identifier: Apache-2.0
// Goal: a row that nobody has filled names nothing and counts nothing, so that a tool which fills rows by
// hand cannot leave one out and get a place of the table instead. Method: every row, event and snapshot as it
// is made.
#include <gtest/gtest.h>

#include "mamori/kernel/component/detail/fsm_machine.hpp"
#include "mamori/kernel/parameter/configuration_finding.hpp"
#include "mamori/kernel/parameter/configuration_table.hpp"
#include "mamori/kernel/parameter/parameter_base.hpp"
#include "mamori/kernel/payload/timed_types.hpp"
#include "mamori/kernel/record/event_log.hpp"
#include "mamori/kernel/record/flight_format.hpp"
#include "mamori/kernel/run/introspection_rows.hpp"
#include "mamori/kernel/table/system_finding.hpp"
#include "mamori/kernel/table/system_table.hpp"
#include "mamori/trace/verifies.hpp"

namespace mamori {
namespace {

using namespace verification;

template <typename... Numbers>
constexpr bool are_zero(Numbers... numbers) noexcept {
    return (... && (numbers == Numbers{0}));
}

constexpr bool is_empty(const WindowRow& row) noexcept {
    return row.name == nullptr && row.background_of == kNoIndex && row.trigger == nullptr &&
           row.kind == ExecutionKind::kPeriodic &&
           are_zero(row.offset.ns, row.length.ns, row.period.ns, row.budget.ns, row.execution_budget.ns,
                    row.alternative_count, row.core, row.first_component, row.component_count, row.first_port,
                    row.port_count, row.first_latch, row.latch_count, row.first_parameter,
                    row.parameter_count) &&
           row.events_per_cycle == 1U && row.has_outputs && row.has_deliveries && !row.has_hand_on;
}
constexpr bool is_empty(const ComponentRow& row) noexcept {
    return row.window == kNoIndex && row.modes == kEveryMode &&
           are_zero(row.worst_case.ns, row.first_port, row.port_count, row.first_outgoing,
                    row.outgoing_count);
}
constexpr bool is_empty(const ConnectionRow& row) noexcept {
    return row.source == nullptr && row.sink == nullptr && row.crossing == nullptr &&
           row.age_max == Duration{0} && !row.is_delayed_by_a_frame && row.source_window == kNoIndex &&
           row.sink_window == kNoIndex && row.source_component == kNoIndex &&
           row.sink_component == kNoIndex && !row.is_forward_in_window && row.get_modes() == kEveryMode;
}
constexpr bool is_empty(const ModeTransitionRow& row) noexcept {
    return row.source == kNoIndex && row.target == kNoIndex && row.event == 0U;
}
constexpr bool is_empty(const CoreSnapshot& row) noexcept {
    return are_zero(row.observed_at.ns, row.frame, row.trace_hash);
}
constexpr bool is_empty(const WindowSnapshot& row) noexcept {
    return row.hanging_component == kNoIndex && row.last_outcome == WindowOutcome::kStopped &&
           are_zero(row.core, row.cycles, row.overruns, row.late_releases, row.worst_lateness.ns,
                    row.budget.ns, row.last_used.ns, row.worst_used.ns);
}
constexpr bool is_empty(const PortSnapshot& row) noexcept {
    return row.component == kNoIndex && !row.is_input && !row.has_value && row.sequence == 0U;
}

TEST(EmptyRowTest, ARowOfATableNamesNothing) {
    verifies("SWR-KRN-025", Technique::kBoundaryValues);
    static_assert(is_empty(WindowRow{}) && is_empty(ComponentRow{}) && is_empty(ConnectionRow{}));
    static_assert(PortRow{}.window == kNoIndex && PortRow{}.component == kNoIndex && !PortRow{}.is_mandatory);
    static_assert(is_empty(ModeTransitionRow{}) && SystemModeRow{}.set == kNoIndex &&
                  !SystemModeRow{}.is_safe);
    static_assert(ModeMemberRow{}.index == kNoIndex && ModeMemberRow{}.mode == 0U);
    static_assert(ConnectionModeRow{}.mode == kNoIndex && ConnectionModeRow{}.connection == 0U);
    static_assert(are_zero(FaultRow{}.fault, ReactionRow{}.fault, ReactionRow{}.reaction));
    static_assert(are_zero(ConfigurationSetRow{}.first_assignment, ConfigurationSetRow{}.assignment_count));
    static_assert(are_zero(AssignmentRow{}.first_value, AssignmentRow{}.value_count));
    static_assert(!AssignmentRow{}.is_known && !AssignmentRow{}.is_refused);
    static_assert(are_zero(FsmTransition{}.source, FsmTransition{}.message, FsmTransition{}.target));
    static_assert(are_zero(FsmTable{}.initial, FsmElement{}.index));
    EXPECT_EQ(make_view(SystemTable<1U, 1U, 1U, 1U>{}).windows[0].component_count, 0U);
}

TEST(EmptyRowTest, AFindingPointsAtTheFirstRowOfNoRule) {
    verifies("SWR-KRN-025", Technique::kBoundaryValues);
    static_assert(Finding{}.rule == Rule::kNone && are_zero(Finding{}.element, Finding{}.other));
    static_assert(ConfigurationFinding{}.rule == ConfigurationRule::kNone);
    EXPECT_EQ(ConfigurationFinding{}.set + ConfigurationFinding{}.assignment, 0U);
}

TEST(EmptyRowTest, AnEventASnapshotAndANumberAreZero) {
    verifies("SWR-KRN-025", Technique::kBoundaryValues);
    static_assert(
        are_zero(Event{}.sequence, Event{}.source, Event{}.code, Event{}.argument, Event{}.time.ns));
    static_assert(are_zero(FlightRecord{}.sequence, FlightRecord{}.argument, FlightRecord{}.session,
                           FlightRecord{}.source, FlightRecord{}.code, FlightRecord{}.time.ns));
    static_assert(are_zero(FlightSession{}.number, FlightSession{}.next_sequence));
    static_assert(are_zero(FsmEvent{}.message, FsmEvent{}.argument, FsmStep{}.transition));
    static_assert(is_empty(CoreSnapshot{}) && is_empty(WindowSnapshot{}) && is_empty(PortSnapshot{}));
    static_assert(ComponentSnapshot{}.window == kNoIndex && ComponentSnapshot{}.cycles == 0U);
    static_assert(are_zero(rtc::Time{}.sec, rtc::Time{}.nsec, rtc::TimedState{}.data, Duration{}.ns));
    static_assert(are_zero(Whole{}.magnitude, ScalarRange{}.element) && !Whole{}.is_negative);
    static_assert(!ScalarRange{}.has_lower && !ScalarRange{}.has_upper);
    EXPECT_FALSE(ScalarRange{}.is_lower_open || ScalarRange{}.is_upper_open);
}

}  // namespace
}  // namespace mamori
