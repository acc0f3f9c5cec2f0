// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <sstream>

#include "describe_modes.hpp"
#include "element_names.hpp"
#include "mamori/table_dump/table_dump.hpp"

namespace mamori::table_dump {
namespace {

std::string format_rate(double rate_hz) {
    std::ostringstream text;
    text << rate_hz << " Hz";
    return text.str();
}

std::string describe_alternatives(const WindowRow& row) {
    std::string text;
    for (std::size_t i = 0U; i < row.alternative_count && i < kAlternativeRateMax; ++i) {
        text += (i == 0U ? "" : ", ") + format(row.alternative_periods[i]);
    }
    return text;
}

std::string describe_worst_cases(const SystemView& view, const WindowRow& row) {
    std::string text;
    for (std::size_t i = 0U; i < std::min(row.component_count, view.components.size()); ++i) {
        const std::size_t component = row.first_component + i;
        text += (i == 0U ? "" : ", ") + get_component_name(view, component) + " " +
                format(get_row(view.component_rows, component).worst_case);
    }
    return text;
}

/// The window rules, without the preceding name of the window.
std::string describe_window(const Finding& finding, const SystemView& view) {
    const WindowRow row = get_row(view.windows, finding.element);
    switch (finding.rule) {
        case Rule::kWindowRowInvalid:
            return "row " + std::to_string(finding.element) + " is invalid";
        case Rule::kWindowNamedTwice:
            return "row " + std::to_string(finding.element) + " has the name of row " +
                   std::to_string(finding.other);
        case Rule::kTriggerUsedTwice:
            return "its trigger releases window " + quote(get_window_name(view, finding.other)) + " too";
        case Rule::kPeriodNotInFrame:
            return "its period of " + format(row.period) + " does not divide the major frame of " +
                   format(view.frame);
        case Rule::kWindowOutsideFrame:
            return "it starts at " + format(row.offset) + " for " + format(row.length) +
                   " and is not inside its period of " + format(row.period);
        case Rule::kWindowsOverlap:
            return "it overlaps window " + quote(get_window_name(view, finding.other)) + " on core " +
                   std::to_string(row.core);
        case Rule::kBudgetExceedsWindow:
            return "its budget of " + format(get_declared_budget(row)) + " is not in 1 ns .. its length of " +
                   format(row.length);
        case Rule::kWorstCasesExceedBudget:
            return "the worst cases of its components are longer than its budget of " +
                   format(get_declared_budget(row)) + ": " + describe_worst_cases(view, row);
        case Rule::kBackgroundTooSlow:
            return "its budget of " + format(row.execution_budget) + " does not fit into its length of " +
                   format(row.length) + " with the windows of core " + std::to_string(row.background_of) +
                   " that preempt it and the publication margin of " + format(view.publication_margin);
        case Rule::kStackOutOfRange:
            return "its stack is not a multiple of 1 KiB in 1 KiB .. " + std::to_string(kStackKibMax) +
                   " KiB";
        case Rule::kRateNotOccurrences:
            return "its rate of " + format_rate(row.rate_hz) + " does not match its window starts, every " +
                   format(row.period);
        case Rule::kRateNotReachable:
            return "a slower period is not a multiple of its period of " + format(row.period) + ": " +
                   describe_alternatives(row);
        default:
            return {};
    }
}

std::string describe_namesake(const Finding& finding) {
    const std::string row = ": row " + std::to_string(finding.element);
    return finding.element == finding.other ? row + " has no name"
                                            : row + " has the name of row " + std::to_string(finding.other);
}

/// The rules for names and for the lists of ports and parameters.
std::string describe_names(const Finding& finding, const SystemView& view) {
    const std::string component = "component " + quote(get_component_name(view, finding.element));
    const std::string port = "port " + quote(get_input_name(view, finding.element));
    const std::string parameter = "parameter " + quote(get_parameter_name(view, finding.element));
    switch (finding.rule) {
        case Rule::kComponentNamedTwice:
            return component + describe_namesake(finding);
        case Rule::kPortNotListed:
            return component + " does not list port " +
                   quote(get_unlisted_name(view, finding, MemberKind::kPort));
        case Rule::kPortNotOwned:
            return port + " is not constructed with its component";
        case Rule::kPortNamedTwice:
            return port + describe_namesake(finding);
        case Rule::kParameterNotListed:
            return component + " does not list parameter " +
                   quote(get_unlisted_name(view, finding, MemberKind::kParameter));
        case Rule::kParameterNotOwned:
            return parameter + " is not constructed with its component";
        case Rule::kParameterNamedTwice:
            return parameter + describe_namesake(finding);
        default:
            return {};
    }
}

/// The rules for inputs and connections.
std::string describe_wiring(const Finding& finding, const SystemView& view) {
    const std::string connection = "connection " + quote(get_connection_name(view, finding.element));
    const ConnectionRow row = get_row(view.connections, finding.element);
    switch (finding.rule) {
        case Rule::kConnectionRowInvalid:
            return connection + ": row " + std::to_string(finding.element) + " is invalid";
        case Rule::kPortOfUnknownComponent:
            return connection + ": one end belongs to no component that a window runs";
        case Rule::kInputNotConnected:
            return "input " + quote(get_input_name(view, finding.element)) +
                   " is mandatory and has no connection";
        case Rule::kInputHasTwoWriters:
            return "input " + quote(get_input_name(view, finding.element)) + " has more than one connection";
        case Rule::kAgeLimitNotPositive:
            return connection + (row.age_max == Duration{0}
                                     ? ": its age limit is not stated"
                                     : ": no value is fresh within " + format(row.age_max));
        case Rule::kAgeLimitCannotBeMet:
            return connection + ": no value is fresh within " + format(row.age_max) +
                   " when its reader starts";
        case Rule::kDelayNotStated:
            return connection + (row.is_delayed_by_a_frame ? " states a delay that it does not have"
                                                           : " is delayed but does not state the delay");
        case Rule::kCrossingWithoutBuffer:
            return connection + " leaves its core or partition without a Crossing or a queue";
        case Rule::kCrossingUsedTwice:
            return connection + " uses the Crossing of " + quote(get_connection_name(view, finding.other));
        case Rule::kHistoryTooShort:
            return connection + ": window " + quote(get_window_name(view, row.sink_window)) +
                   " may start when window " + quote(get_window_name(view, row.source_window)) +
                   " has published two newer values";
        case Rule::kMarginNotKept:
            return connection + ": window " + quote(get_window_name(view, row.sink_window)) +
                   " may start within the publication margin of " + format(view.publication_margin) +
                   " after window " + quote(get_window_name(view, row.source_window));
        default:
            return {};
    }
}

std::string describe_reactions(const Finding& finding, const SystemView& view) {
    const std::string fault = "fault " + std::to_string(get_row(view.faults, finding.element).fault);
    const std::string reaction =
        "the reaction to fault " + std::to_string(get_row(view.reactions, finding.element).fault);
    const std::string mode =
        view.modes.modes.empty() ? "" : " in mode " + quote(get_mode_name(view, finding.other));
    switch (finding.rule) {
        case Rule::kFaultDeclaredTwice:
            return fault + " is declared twice";
        case Rule::kFaultWithoutReaction:
            return fault + " has no reaction" + mode;
        case Rule::kFaultWithTwoReactions:
            return fault + " has more than one reaction" + mode;
        case Rule::kReactionInUnknownMode:
            return reaction + " names no mode, or one that is not in the table";
        case Rule::kReactionWithoutTime:
            return reaction + " has " + format(get_row(view.reactions, finding.element).within);
        case Rule::kReactionToUnknownFault:
            return reaction + " is for a fault that is not declared";
        default:
            return {};
    }
}

/// The faulty element and its values.
std::string describe_element(const Finding& finding, const SystemView& view) {
    switch (finding.rule) {
        case Rule::kNone:
            break;
        case Rule::kFrameNotPositive:
            return "the major frame of " + format(view.frame) + " is not positive";
        case Rule::kWindowRowInvalid:
        case Rule::kWindowNamedTwice:
        case Rule::kTriggerUsedTwice:
        case Rule::kPeriodNotInFrame:
        case Rule::kWindowOutsideFrame:
        case Rule::kWindowsOverlap:
        case Rule::kBudgetExceedsWindow:
        case Rule::kBackgroundTooSlow:
        case Rule::kStackOutOfRange:
        case Rule::kWorstCasesExceedBudget:
        case Rule::kRateNotOccurrences:
        case Rule::kRateNotReachable:
            return "window " + quote(get_window_name(view, finding.element)) + ": " +
                   describe_window(finding, view);
        case Rule::kComponentRowInvalid:
            return "component " + quote(get_component_name(view, finding.element)) + ": row " +
                   std::to_string(finding.element) + " is invalid";
        case Rule::kPortRowInvalid:
            return "port " + quote(get_input_name(view, finding.element)) + ": row " +
                   std::to_string(finding.element) + " is invalid";
        case Rule::kComponentNamedTwice:
        case Rule::kPortNotListed:
        case Rule::kPortNotOwned:
        case Rule::kPortNamedTwice:
        case Rule::kParameterNotListed:
        case Rule::kParameterNotOwned:
        case Rule::kParameterNamedTwice:
            return describe_names(finding, view);
        case Rule::kComponentInTwoPlaces:
            return "component " + quote(get_component_name(view, finding.element)) + " runs in window " +
                   quote(get_window_name(view, get_row(view.component_rows, finding.other).window)) +
                   " and again in window " +
                   quote(get_window_name(view, get_row(view.component_rows, finding.element).window));
        case Rule::kConnectionRowInvalid:
        case Rule::kPortOfUnknownComponent:
        case Rule::kInputNotConnected:
        case Rule::kInputHasTwoWriters:
        case Rule::kAgeLimitNotPositive:
        case Rule::kAgeLimitCannotBeMet:
        case Rule::kDelayNotStated:
        case Rule::kCrossingWithoutBuffer:
        case Rule::kCrossingUsedTwice:
        case Rule::kHistoryTooShort:
        case Rule::kMarginNotKept:
            return describe_wiring(finding, view);
        case Rule::kFaultDeclaredTwice:
        case Rule::kFaultWithoutReaction:
        case Rule::kFaultWithTwoReactions:
        case Rule::kReactionInUnknownMode:
        case Rule::kReactionWithoutTime:
        case Rule::kReactionToUnknownFault:
            return describe_reactions(finding, view);
        case Rule::kModelledTimeNegative:
        case Rule::kModelledTimeOfUnknownComponent:
        case Rule::kModelledTimeStatedTwice:
            return "modelled time: row " + std::to_string(finding.element) + " is invalid";
        case Rule::kActionBudgetOutOfRange:
            return "the action budget is not positive or exceeds one hour";
        case Rule::kParameterRowInvalid:
        case Rule::kSetRowInvalid:
        case Rule::kConfigurationRefused:
        case Rule::kModeRowInvalid:
        case Rule::kModeNamedTwice:
        case Rule::kModeOfUnknownComponent:
        case Rule::kModeOfUnknownSet:
        case Rule::kComponentInNoMode:
        case Rule::kInputNotFedInMode:
        case Rule::kConnectionOfUnknownMode:
        case Rule::kTransitionOfUnknownMode:
        case Rule::kTransitionAmbiguous:
        case Rule::kModeUnreachable:
        case Rule::kNoSafeMode:
        case Rule::kTwoSafeModes:
        case Rule::kSafeModeIsLeft:
        case Rule::kSafeModeActivates:
            return describe_modes(finding, view);
    }
    return {};
}

}  // namespace

std::string describe(const Finding& finding, const SystemView& view) {
    if (finding.rule == Rule::kNone) {
        return get_sentence(finding.rule);
    }
    const std::string element = describe_element(finding, view);
    return element.empty() ? "no rule has the number " + std::to_string(static_cast<int>(finding.rule))
                           : element + "; rule: " + get_sentence(finding.rule);
}

std::vector<std::string> describe_all(const SystemView& view) {
    std::vector<Finding> findings(check_all(view, {}));
    static_cast<void>(check_all(view, {findings.data(), findings.size()}));
    std::vector<std::string> sentences;
    for (const Finding& finding : findings) {
        sentences.push_back(describe(finding, view));
    }
    return sentences;
}

}  // namespace mamori::table_dump
