// SPDX-License-Identifier: Apache-2.0
// Goal: the compiler refuses what could not work, and its message names the rule and the guilty element.
// Method: support/compilation.hpp.
#include <gtest/gtest.h>

#include "mamori/trace/verifies.hpp"
#include "support/compilation.hpp"

namespace mamori {
namespace {

using testing_support::expect_explained;
using testing_support::expect_refused;
using namespace verification;

TEST(CompileFailTest, AConnectionOfTwoPayloadTypesIsRefused) {
    verifies("SWR-KRN-018", Technique::kInterface, Polarity::kViolation);
    expect_refused("connections", "payload_mismatch", "connect() joins ports of one payload type");
}

TEST(CompileFailTest, AQueuedOutputOfAnotherPayloadTypeIsRefused) {
    verifies("SWR-KRN-053", Technique::kInterface, Polarity::kViolation);
    expect_refused("connections", "queue_payload_mismatch", "connect() joins ports of one payload type");
}

TEST(CompileFailTest, AQueuedOutputWithoutRoomIsRefused) {
    verifies("SWR-KRN-053", Technique::kBoundaryValues, Polarity::kViolation);
    expect_refused("connections", "queue_without_room", "a QueueOutPort has room for 1 to 254 values");
}

TEST(CompileFailTest, AMandatoryInputWithoutASourceIsRefused) {
    verifies("SWR-KRN-018", Technique::kInterface, Polarity::kViolation);
    expect_refused("connections", "input_not_connected", "InputIsConnected<Consumer, &Consumer::in, 0>");
}

TEST(CompileFailTest, ASecondWriterOfAnInputIsRefused) {
    verifies("SWR-KRN-018", Technique::kInterface, Polarity::kViolation);
    expect_refused("connections", "two_writers", "InputHasOneWriter<Consumer, &Consumer::in, 0>");
}

TEST(CompileFailTest, AComponentInTwoWindowsIsRefused) {
    verifies("SWR-KRN-018", Technique::kInterface, Polarity::kViolation);
    expect_refused("windows", "component_in_two_windows", "ComponentRunsInOneContext<Producer, 1>");
}

TEST(CompileFailTest, OverlappingWindowsAreRefused) {
    verifies("SWR-KRN-018", Technique::kInterface, Polarity::kViolation);
    expect_refused("windows", "windows_overlap", "WindowsAreDisjoint<mamori::Name<'a'>, mamori::Name<'b'>");
}

TEST(CompileFailTest, AWindowOutsideTheFrameIsRefused) {
    verifies("SWR-KRN-018", Technique::kInterface, Polarity::kViolation);
    expect_refused("windows", "window_outside_frame", "WindowIsInsideItsPeriod<mamori::Name<'a'>");
}

TEST(CompileFailTest, ABudgetOverItsWindowIsRefused) {
    verifies("SWR-KRN-018", Technique::kInterface, Polarity::kViolation);
    expect_refused("windows", "budget_over_window", "BudgetIsInsideWindow<mamori::Name<'a'>");
}

TEST(CompileFailTest, AConnectionOfAComponentThatNoWindowRunsIsRefused) {
    verifies("SWR-KRN-018", Technique::kInterface, Polarity::kViolation);
    expect_refused("connections", "unknown_component",
                   "ConnectionJoinsComponentsOfTheTable<mamori::PortMember<Producer, &Producer::real>, "
                   "mamori::detail::PortOfNoComponentOfTheTable, mamori::rules::Row<0>");
}

TEST(CompileFailTest, APeriodThatDoesNotDivideTheFrameIsRefused) {
    verifies("SWR-KRN-018", Technique::kInterface, Polarity::kViolation);
    expect_refused("windows", "period_not_in_frame",
                   "PeriodDividesFrame<mamori::Name<'s', 'e', 'n', 's', 'e'>");
}

TEST(CompileFailTest, ADeclaredRateThatIsNotThatOfTheOpeningsIsRefused) {
    verifies("SWR-KRN-018", Technique::kInterface, Polarity::kViolation);
    expect_refused("windows", "rate_not_occurrences",
                   "RateEqualsOccurrences<mamori::Name<'s', 'e', 'n', 's', 'e'>");
}

TEST(CompileFailTest, ASlowerRateThatCannotBeReachedIsRefused) {
    verifies("SWR-KRN-018", Technique::kInterface, Polarity::kViolation);
    expect_refused("windows", "rate_not_reachable",
                   "AlternativeRateDividesRate<mamori::Name<'s', 'e', 'n', 's', 'e'>");
}

TEST(CompileFailTest, WorstCasesOverTheBudgetAreRefused) {
    verifies("SWR-KRN-018", Technique::kInterface, Polarity::kViolation);
    expect_refused("windows", "worst_cases_over_budget",
                   "WorstCasesFitBudget<mamori::Name<'s', 'e', 'n', 's', 'e'>");
}

TEST(CompileFailTest, AWorstCaseBelowZeroIsRefused) {
    verifies("SWR-KRN-018", Technique::kBoundaryValues, Polarity::kViolation);
    expect_refused("windows", "worst_case_negative", "WorstCaseIsNotNegative<Producer, 0>");
}

TEST(CompileFailTest, AWindowThatServesNoEventIsRefused) {
    verifies("SWR-KRN-018", Technique::kBoundaryValues, Polarity::kViolation);
    expect_refused("windows", "window_without_events", "WindowRowIsValid<mamori::rules::Row<0>");
}

TEST(CompileFailTest, ADeclaredFaultWithoutAReactionIsRefused) {
    verifies("SWR-FLT-004", Technique::kInterface, Polarity::kViolation);
    expect_refused("reactions", "fault_without_reaction", "FaultHasReaction<Fault::kTrackingLost>");
}

TEST(CompileFailTest, ADeclaredFaultWithTwoReactionsIsRefused) {
    verifies("SWR-FLT-004", Technique::kInterface, Polarity::kViolation);
    expect_refused("reactions", "fault_with_two_reactions", "FaultHasOneReaction<Fault::kOverspeed>");
}

TEST(CompileFailTest, AFaultWithoutOrWithTwoReactionsInAModeIsRefused) {
    verifies("SWR-FLT-011", Technique::kInterface, Polarity::kViolation);
    expect_refused("reactions", "fault_without_reaction_in_a_mode",
                   "FaultHasReaction<Fault::kOverspeed, mamori::Name<'h', 'a', 'l', 't'>");
    expect_refused("reactions", "fault_with_two_reactions_in_a_mode",
                   "FaultHasOneReaction<Fault::kOverspeed, mamori::Name<'h', 'a', 'l', 't'>");
    expect_refused("reactions", "reaction_in_unknown_mode", "ReactionHasKnownModes<mamori::rules::Row<0>");
}

TEST(CompileFailTest, AReactionWithoutTimeIsRefused) {
    verifies("SWR-KRN-018", Technique::kInterface, Polarity::kViolation);
    expect_refused("reactions", "reaction_without_time", "ReactionHasATime<mamori::rules::Row<0>");
}

TEST(CompileFailTest, AConnectionOutOfItsCoreWithoutABufferIsRefused) {
    verifies("SWR-KRN-018", Technique::kInterface, Polarity::kViolation);
    expect_refused("connections", "crossing_without_buffer",
                   "InputFromElsewhereHasACrossing<Consumer, &Consumer::in, 0>");
}

TEST(CompileFailTest, AConnectionOutOfItsPartitionWithoutABufferIsRefused) {
    verifies("SWR-KRN-018", Technique::kInterface, Polarity::kViolation);
    expect_refused("connections", "partition_without_buffer",
                   "InputFromElsewhereHasACrossing<Consumer, &Consumer::in, 0>");
}

TEST(CompileFailTest, ACrossingOfTwoConnectionsIsRefused) {
    verifies("SWR-KRN-018", Technique::kInterface, Polarity::kViolation);
    expect_refused("connections", "crossing_used_twice",
                   "InputHasACrossingOfItsOwn<Consumer, &Consumer::in, 1>");
}

TEST(CompileFailTest, AReaderWhoseValueMayBeOverwrittenIsRejected) {
    verifies("SWR-KRN-082", Technique::kInterface, Polarity::kViolation);
    expect_refused("connections", "history_too_short",
                   "ReaderStartsBeforeValueIsOverwritten<Consumer, &Consumer::in, 0>");
}

TEST(CompileFailTest, ABackgroundWindowThatCannotCompleteIsRejectedByItsName) {
    verifies("SWR-KRN-081", Technique::kInterface, Polarity::kViolation);
    expect_refused("windows", "background_too_slow",
                   "BackgroundWindowCanComplete<mamori::Name<'p', 'l', 'a', 'n'>");
}

TEST(CompileFailTest, AReaderThatStartsWithinThePublicationMarginIsRefused) {
    verifies("SWR-KRN-051", Technique::kInterface, Polarity::kViolation);
    expect_refused("connections", "margin_not_kept",
                   "ReaderStartsAfterPublicationMargin<Consumer, &Consumer::in, 0>");
}

TEST(CompileFailTest, WindowsOfOneNameAreRefused) {
    verifies("SWR-KRN-018", Technique::kEquivalenceClasses, Polarity::kViolation);
    expect_refused("windows", "window_named_twice",
                   "WindowHasANameOfItsOwn<mamori::Name<'s', 'e', 'n', 's', 'e'>");
}

TEST(CompileFailTest, AnAgeLimitAtWhichNothingIsFreshIsRefused) {
    verifies("SWR-KRN-018", Technique::kBoundaryValues, Polarity::kViolation);
    expect_refused("connections", "age_limit_not_positive", "InputCanBeFresh<Consumer, &Consumer::in, 0>");
}

TEST(CompileFailTest, ADeclaredRateOfZeroIsRefused) {
    verifies("SWR-KRN-018", Technique::kBoundaryValues, Polarity::kViolation);
    expect_refused("windows", "rate_of_zero", "RateEqualsOccurrences<mamori::Name<'s', 'e', 'n', 's', 'e'>");
}

TEST(CompileFailTest, ASecondBudgetOfAWindowIsRefused) {
    verifies("SWR-KRN-018", Technique::kErrorGuessing, Polarity::kViolation);
    expect_refused("windows", "window_option_twice", "each option of a window is said once");
}

TEST(CompileFailTest, ASecondListOfRatesIsRefused) {
    verifies("SWR-KRN-018", Technique::kErrorGuessing, Polarity::kViolation);
    expect_refused("windows", "window_rates_twice", "each option of a window is said once");
}

TEST(CompileFailTest, AWindowWithATriggerAndEventsIsRefused) {
    verifies("SWR-KRN-018", Technique::kErrorGuessing, Polarity::kViolation);
    expect_refused("windows", "window_of_two_kinds", "not both");
}

TEST(CompileFailTest, ASecondAgeLimitOfAConnectionIsRefused) {
    verifies("SWR-KRN-018", Technique::kErrorGuessing, Polarity::kViolation);
    expect_refused("connections", "connection_option_twice", "each option of a connection is said once");
}

TEST(CompileFailTest, ASecondAbortPolicyIsRefused) {
    verifies("SWR-KRN-018", Technique::kErrorGuessing, Polarity::kViolation);
    expect_refused("windows", "abort_policy_twice", "abort_policy(...) is said once");
}

TEST(CompileFailTest, ASecondRequestOfTheTraceHashIsRefused) {
    verifies("SWR-KRN-018", Technique::kErrorGuessing, Polarity::kViolation);
    expect_refused("windows", "trace_hash_twice", "duplicate trace_hash(); specify it at most once");
}

TEST(CompileFailTest, AReactionToAFaultOfAnotherEnumerationIsRefused) {
    verifies("SWR-KRN-018", Technique::kErrorGuessing, Polarity::kViolation);
    expect_refused("reactions", "faults_of_two_enumerations",
                   "all faults of a system are enumerators of one enumeration");
}

TEST(CompileFailTest, ReactionsOfTwoEnumerationsAreRefused) {
    verifies("SWR-KRN-018", Technique::kErrorGuessing, Polarity::kViolation);
    expect_refused("reactions", "reactions_of_two_enumerations", "and so are all reactions");
}

TEST(CompileFailTest, ATriggerOfTwoWindowsIsRefused) {
    verifies("SWR-KRN-018", Technique::kErrorGuessing, Polarity::kViolation);
    expect_refused("windows", "trigger_used_twice",
                   "TriggerServesOneWindow<mamori::Name<'a'>, mamori::Name<'b'>");
}

TEST(CompileFailTest, APeriodOfZeroIsRefused) {
    verifies("SWR-KRN-018", Technique::kBoundaryValues, Polarity::kViolation);
    expect_refused("windows", "period_of_zero", "WindowRowIsValid<mamori::rules::Row<0>");
}

TEST(CompileFailTest, AFaultThatIsDeclaredTwiceIsRefused) {
    verifies("SWR-KRN-018", Technique::kErrorGuessing, Polarity::kViolation);
    expect_refused("reactions", "fault_declared_twice", "FaultIsDeclaredOnce<Fault::kOverspeed>");
}

TEST(CompileFailTest, AMemberThatIsNoPortIsRefused) {
    verifies("SWR-KRN-018", Technique::kInterface, Polarity::kViolation);
    expect_refused("connections", "port_is_no_port",
                   "ListNamesMembersOfItsComponent<port_is_no_port::Odd, &port_is_no_port::Odd::number>");
}

TEST(CompileFailTest, APayloadWithoutAFieldListIsRefused) {
    verifies("SWR-KRN-005", Technique::kInterface, Polarity::kViolation);
    expect_explained("payloads", "payload_without_fields", "MAMORI_FIELDS");
}

TEST(CompileFailTest, AFieldListThatLeavesAFieldOutIsRefused) {
    verifies("SWR-CDR-001", Technique::kInterface, Polarity::kViolation);
    expect_explained("payloads", "fields_left_out", "decomposes into 3 elements");
}

TEST(CompileFailTest, AFieldListInAnotherOrderThanTheTypeIsRefused) {
    verifies("SWR-CDR-001", Technique::kInterface, Polarity::kViolation);
    expect_refused("payloads", "fields_in_wrong_order", "in the order of their declaration");
}

TEST(CompileFailTest, AFieldListThatNamesAStrangerIsRefused) {
    verifies("SWR-CDR-001", Technique::kInterface, Polarity::kViolation);
    expect_refused("payloads", "fields_unknown", "velocty");
}

TEST(CompileFailTest, AnEnumerationWithoutItsLastEnumeratorIsNotEncoded) {
    verifies("SWR-CDR-015", Technique::kInterface, Polarity::kViolation);
    expect_explained("payloads", "enumeration_without_last", "MAMORI_LAST_ENUMERATOR");
}

TEST(CompileFailTest, AWideCharacterIsNotEncoded) {
    verifies("SWR-CDR-010", Technique::kInterface, Polarity::kViolation);
    expect_explained("payloads", "wide_character", "wide characters have no encoding");
}

TEST(CompileFailTest, ALiteralThatIsTooLongIsRefused) {
    verifies("SWR-CDR-003", Technique::kInterface, Polarity::kViolation);
    expect_refused("payloads", "literal_too_long", "longer than the string holds");
}

TEST(CompileFailTest, AnArrayThatIsTooLongIsRefused) {
    verifies("SWR-CDR-002", Technique::kInterface, Polarity::kViolation);
    expect_refused("payloads", "array_too_long", "more elements than the sequence holds");
}

TEST(CompileFailTest, ABufferOfAPayloadThatIsNotTriviallyCopyableIsRefused) {
    verifies("SWR-BUF-008", Technique::kInterface, Polarity::kViolation);
    expect_refused("payloads", "fifo_payload", "the payload of a FifoBuffer must be trivially copyable");
    expect_refused("payloads", "snapshot_payload",
                   "the payload of a SnapshotCell must be trivially copyable");
}

TEST(CompileFailTest, AFifoWithoutRoomOrWithTooMuchIsRefused) {
    verifies("SWR-BUF-008", Technique::kBoundaryValues, Polarity::kViolation);
    expect_explained("payloads", "fifo_capacity", "a FIFO needs room for at least one entry", "0");
    expect_explained("payloads", "fifo_capacity", "a FIFO has room for at most 254 entries", "255");
}

TEST(CompileFailTest, AStateMachineWithAnUnreachableStateIsRefused) {
    verifies("SWR-RTC-006", Technique::kInterface, Polarity::kViolation);
    expect_refused("payloads", "fsm_state_unreachable", "kStateUnreachable");
}

TEST(CompileFailTest, AStatusThatIsDroppedIsRefused) {
    verifies("SWR-KRN-001", Technique::kInterface, Polarity::kViolation);
    expect_refused("payloads", "status_ignored", "nodiscard");
}

TEST(CompileFailTest, APortThatItsComponentDoesNotListIsNamed) {
    verifies("SWR-KRN-045", Technique::kInterface, Polarity::kViolation);
    expect_refused("ports", "port_not_listed",
                   "PortIsListed<port_not_listed::Monitor, mamori::Name<'s', 'p', 'e', 'e', 'd'>");
    expect_refused("ports", "no_port_listed",
                   "PortIsListed<no_port_listed::Monitor, mamori::Name<'s', 'p', 'e', 'e', 'd'>");
}

TEST(CompileFailTest, AListedPortWithoutItsComponentIsRefused) {
    verifies("SWR-KRN-045", Technique::kInterface, Polarity::kViolation);
    expect_refused("ports", "port_not_owned",
                   "PortIsOwned<port_not_owned::Monitor, &port_not_owned::Monitor::speed, 0>");
    expect_refused("ports", "port_without_owner", "OutPort<double>");
}

TEST(CompileFailTest, TwoPortsOfOneNameAndAPortListedTwiceAreRefused) {
    verifies("SWR-KRN-046", Technique::kInterface, Polarity::kViolation);
    expect_refused("ports", "port_named_twice",
                   "PortHasANameOfItsOwn<port_named_twice::Monitor, &port_named_twice::Monitor::right, 0>");
    expect_refused("ports", "port_listed_twice",
                   "PortHasANameOfItsOwn<port_listed_twice::Monitor, &port_listed_twice::Monitor::speed, 0>");
}

TEST(CompileFailTest, AConnectionWithoutAnAgeLimitOrWithTwoIsRefused) {
    verifies("SWR-KRN-047", Technique::kInterface, Polarity::kViolation);
    expect_refused("connections", "age_limit_not_stated", "InputCanBeFresh<Consumer, &Consumer::in, 0>");
    expect_refused("connections", "two_age_limits", "fresh_within(...) or any_age(), not both");
}

TEST(CompileFailTest, ADelayThatIsNotStatedOrNotThereIsRefused) {
    verifies("SWR-KRN-048", Technique::kInterface, Polarity::kViolation);
    expect_refused("connections", "delay_not_stated", "ConnectionStatesItsDelay<Consumer, &Consumer::in, 0>");
    expect_refused("connections", "delay_stated_without_delay",
                   "ConnectionStatesItsDelay<Consumer, &Consumer::in, 0>");
    expect_refused("connections", "own_output_without_delay",
                   "ConnectionStatesItsDelay<own_output_without_delay::Filter, "
                   "&own_output_without_delay::Filter::last, 0>");
}

TEST(CompileFailTest, AListOfWhatIsNoPortOfTheComponentIsRefused) {
    verifies("SWR-KRN-062", Technique::kErrorGuessing, Polarity::kViolation);
    expect_refused("ports", "port_of_other_component",
                   "ListNamesMembersOfItsComponent<port_of_other_component::Monitor, &Producer::real>");
    const std::string list = "ListNamesMembersOfItsComponent<list_without_port::Monitor, ";
    expect_refused("ports", "list_without_port", list + "&list_without_port::Monitor::gain>", "1");
    expect_refused("ports", "list_without_port", list + "&list_without_port::Monitor::on_execute>", "2");
    expect_refused("ports", "list_without_port", list, "3");
    expect_refused("ports", "list_without_port", list, "4");
}

TEST(CompileFailTest, APrivateListOfPortsIsNoList) {
    verifies("SWR-KRN-045", Technique::kErrorGuessing, Polarity::kViolation);
    expect_refused("ports", "port_list_private",
                   "PortIsListed<port_list_private::Monitor, mamori::Name<'s', 'p', 'e', 'e', 'd'>");
}

TEST(CompileFailTest, APortWithoutANameIsRefused) {
    verifies("SWR-KRN-046", Technique::kBoundaryValues, Polarity::kViolation);
    for (const char* empty_or_missing : {"1", "2"}) {
        expect_refused(
            "ports", "port_without_name",
            "PortHasANameOfItsOwn<port_without_name::Monitor, &port_without_name::Monitor::speed, 0>",
            empty_or_missing);
    }
    expect_refused("ports", "unlisted_port_without_name",
                   "PortIsListed<unlisted_port_without_name::Monitor, mamori::Name<>");
}

TEST(CompileFailTest, AConnectionFromAComponentThatNoWindowRunsIsRefused) {
    verifies("SWR-KRN-060", Technique::kInterface, Polarity::kViolation);
    expect_refused("connections", "unknown_source",
                   "ConnectionJoinsComponentsOfTheTable<mamori::detail::PortOfNoComponentOfTheTable, "
                   "mamori::PortMember<Consumer, &Consumer::in>, mamori::rules::Row<0>");
}

TEST(CompileFailTest, AnAgeLimitThatNoValueMeetsIsRefused) {
    verifies("SWR-KRN-061", Technique::kBoundaryValues, Polarity::kViolation);
    for (const char* defect :
         {"age_limit_too_short", "age_limit_of_delayed_value", "age_limit_between_rates"}) {
        expect_refused("connections", defect, "AgeLimitCanBeMet<Consumer, &Consumer::in, 0>");
    }
}

TEST(CompileFailTest, AnAgeLimitOrToleranceBelowZeroIsRefused) {
    verifies("SWR-KRN-018", Technique::kBoundaryValues, Polarity::kViolation);
    for (const char* limit_or_tolerance : {"1", "2"}) {
        expect_refused("connections", "age_limit_negative", "InputCanBeFresh<Consumer, &Consumer::in, 0>",
                       limit_or_tolerance);
    }
}

TEST(CompileFailTest, AConnectionAgainstItsDirectionIsRefused) {
    verifies("SWR-KRN-018", Technique::kErrorGuessing, Polarity::kViolation);
    expect_refused("connections", "connection_direction", "OutPort<double>", "1");
    expect_refused("connections", "connection_direction", "connect() joins an output to an input", "2");
}

TEST(CompileFailTest, ACrossingOfAnotherPayloadTypeIsRefused) {
    verifies("SWR-KRN-018", Technique::kErrorGuessing, Polarity::kViolation);
    expect_explained("connections", "crossing_of_other_type",
                     "the Crossing of a connection carries its payload type");
}

TEST(CompileFailTest, AWindowWithoutANameIsRefused) {
    verifies("SWR-KRN-018", Technique::kBoundaryValues, Polarity::kViolation);
    for (const char* empty_or_missing : {"1", "2"}) {
        expect_refused("windows", "window_without_name", "WindowRowIsValid<mamori::rules::Row<1>",
                       empty_or_missing);
    }
}

TEST(CompileFailTest, AWindowWithoutStartLengthOrBudgetIsRefused) {
    verifies("SWR-KRN-018", Technique::kBoundaryValues, Polarity::kViolation);
    const std::string name = "<mamori::Name<'s', 'e', 'n', 's', 'e'>";
    expect_refused("windows", "window_times", "WindowIsInsideItsPeriod" + name, "1");
    expect_refused("windows", "window_times", "WindowIsInsideItsPeriod" + name, "2");
    expect_refused("windows", "window_times", "BudgetIsInsideWindow" + name, "3");
}

TEST(CompileFailTest, AFrameWithoutLengthIsRefused) {
    verifies("SWR-KRN-018", Technique::kBoundaryValues, Polarity::kViolation);
    expect_refused("windows", "frame_of_zero", "FrameIsPositive<mamori::rules::Row<0>");
}

TEST(CompileFailTest, AComponentThatAWindowRunsTwiceIsRefused) {
    verifies("SWR-KRN-018", Technique::kErrorGuessing, Polarity::kViolation);
    expect_refused("windows", "component_twice_in_window", "ComponentRunsInOneContext<Producer, 1>");
}

TEST(CompileFailTest, AnIndexOfAComponentThatIsNotInTheTableIsRejected) {
    verifies("SWR-KRN-063", Technique::kInterface, Polarity::kViolation);
    expect_explained("index_of", "component_of_no_window", "is_component_of_the_table");
}

TEST(CompileFailTest, AnArrayBoundByAWindowThatIsNotInTheTableIsRejected) {
    verifies("SWR-KRN-063", Technique::kInterface, Polarity::kViolation);
    expect_explained("index_of", "array_bound", "is_window_of_the_table");
}

TEST(CompileFailTest, AModelledTimeOfAComponentThatNoWindowRunsIsRejected) {
    verifies("SWR-KRN-064", Technique::kInterface, Polarity::kViolation);
    expect_refused("modelled_times", "",
                   "ModelledTimeHasAComponentOfTheTable<Consumer, mamori::rules::Row<0>", "1");
}

TEST(CompileFailTest, ASecondModelledTimeOfAComponentIsRejected) {
    verifies("SWR-KRN-064", Technique::kInterface, Polarity::kViolation);
    expect_refused("modelled_times", "", "ModelledTimeIsStatedOnce<Producer, mamori::rules::Row<2>", "2");
}

TEST(CompileFailTest, AModelledTimeBelowZeroIsRejected) {
    verifies("SWR-KRN-064", Technique::kBoundaryValues, Polarity::kViolation);
    expect_refused("modelled_times", "", "ModelledTimeIsNotNegative<Producer, mamori::rules::Row<0>", "3");
}

TEST(CompileFailTest, AnActionBudgetOutsideItsRangeIsRejected) {
    verifies("SWR-KRN-092", Technique::kBoundaryValues, Polarity::kViolation);
    expect_refused("modelled_times", "", "ActionBudgetIsInRange<mamori::rules::Row<0>", "4");
}

TEST(CompileFailTest, ASecondActionBudgetIsRejected) {
    verifies("SWR-KRN-092", Technique::kInterface, Polarity::kViolation);
    expect_explained("modelled_times", "", "duplicate action_budget(...); specify it at most once", "5");
}

TEST(CompileFailTest, ACheckedTableThatBreaksARuleOrIsThatOfAnotherExecutiveIsRefused) {
    verifies("SWR-KRN-070", Technique::kErrorGuessing, Polarity::kViolation);
    expect_explained("windows", "checked_table", "the system table violates a rule", "1");
    expect_explained("windows", "checked_table", "the storage of the executive is that of another table",
                     "2");
}

TEST(CompileFailTest, SystemWindowsWithABudgetCompile) {
    verifies("SWR-KRN-099", Technique::kInterface);
    const testing_support::Compilation& control = testing_support::compile_control("windows");
    EXPECT_TRUE(control.has_succeeded) << control.output;
}

TEST(CompileFailTest, ASystemWindowWithoutBudgetIsRejectedAndItsFunctionNamed) {
    verifies("SWR-KRN-099", Technique::kInterface, Polarity::kViolation);
    expect_refused("windows", "system_window_without_budget",
                   "SystemWindowHasItsBudget<mamori::SystemFunction<");
    expect_refused("windows", "system_window_without_budget", "send_notice>");
}

TEST(CompileFailTest, ASystemWindowWithABudgetOfZeroIsRejectedAndNamed) {
    verifies("SWR-KRN-099", Technique::kBoundaryValues, Polarity::kViolation);
    expect_refused("windows", "system_window_budget_of_zero",
                   "BudgetIsInsideWindow<mamori::Name<'n', 'o', 't', 'i', 'c', 'e'>");
}

TEST(CompileFailTest, ASystemWindowThatRunsAComponentIsRejected) {
    verifies("SWR-KRN-099", Technique::kInterface, Polarity::kViolation);
    expect_refused("windows", "system_window_of_component", "a system window ends with its SystemFunction");
}

TEST(CompileFailTest, ASystemWindowThatWaitsForEventsIsRejected) {
    verifies("SWR-KRN-099", Technique::kInterface, Polarity::kViolation);
    expect_refused("windows", "system_window_of_events",
                   "a system window is periodic; remove event_driven(...) or triggered_by(...)");
}

TEST(CompileFailTest, ASystemWindowThatWaitsForATriggerIsRejected) {
    verifies("SWR-KRN-099", Technique::kInterface, Polarity::kViolation);
    expect_refused("windows", "system_window_of_trigger",
                   "a system window is periodic; remove event_driven(...) or triggered_by(...)");
}

TEST(CompileFailTest, ASystemFunctionOfAnotherTypeIsRejected) {
    verifies("SWR-KRN-099", Technique::kInterface, Polarity::kViolation);
    expect_refused("windows", "system_function_of_integer",
                   "a system function is Status f(ContextHandle) noexcept");
}

TEST(CompileFailTest, APortInCWithAnotherPayloadTypeIsRefused) {
    verifies("SWR-CIF-003", Technique::kInterface, Polarity::kViolation);
    expect_refused("c_ports", "c_input_type", "same payload type in C and in C++");
    expect_refused("c_ports", "c_output_type", "same payload type in C and in C++");
}

TEST(CompileFailTest, TemporaryActionsInCAreRefused) {
    verifies("SWR-CIF-005", Technique::kInterface, Polarity::kViolation);
    expect_explained("c_ports", "temporary_actions", "deleted");
}

TEST(CompileFailTest, ACreateFunctionOfRtmSafetyWithAnotherSignatureOrNoneIsRefused) {
    verifies("SWR-CIF-010", Technique::kInterface, Polarity::kViolation);
    expect_explained("c_ports", "create_signature", "a create function is ReturnCode_t");
    expect_explained("c_ports", "create_null", "a create function is not null");
}

}  // namespace
}  // namespace mamori
