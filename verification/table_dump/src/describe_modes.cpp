// SPDX-License-Identifier: Apache-2.0
#include "describe_modes.hpp"

#include <algorithm>

#include "element_names.hpp"

namespace mamori::table_dump {
namespace {

std::string get_set_name(const SystemView& view, std::size_t index) {
    return "configuration set " + quote(to_text(get_row(view.configuration.sets, index).name));
}

bool is_assignment_whole(const ConfigurationView& view, const AssignmentRow& row) {
    return row.parameter != nullptr && has_range(view.values, row.first_value, row.value_count);
}

bool is_set_whole(const ConfigurationView& view, const ConfigurationSetRow& row) {
    if (row.name == nullptr || !has_range(view.assignments, row.first_assignment, row.assignment_count)) {
        return false;
    }
    const Span<const AssignmentRow> rows = view.get_assignments(row);
    return std::all_of(rows.begin(), rows.end(),
                       [&](const AssignmentRow& each) { return is_assignment_whole(view, each); });
}

std::string describe_set(const Finding& finding, const SystemView& view) {
    const std::string set = get_set_name(view, finding.element);
    if (!describe_broken_configuration(view).empty()) {
        return set + " cannot be judged: a row of the configuration is not whole";
    }
    switch (check(view.configuration).rule) {
        case ConfigurationRule::kSetNamedTwice:
            return set + " has the name of an earlier one";
        case ConfigurationRule::kUnknownParameter:
            return set + ": assignment " + std::to_string(finding.other) +
                   " names a parameter of no component that a window runs";
        case ConfigurationRule::kParameterAssignedTwice:
            return set + ": assignment " + std::to_string(finding.other) + " repeats a parameter";
        case ConfigurationRule::kValueOutsideConstraint:
        case ConfigurationRule::kNone:
            break;
    }
    return set + ": the value of assignment " + std::to_string(finding.other) +
           " is not one that its parameter may have";
}

/// `'idle' -> 'work'`, as the transition spells them.
std::string get_transition_name(const SystemView& view, std::size_t index) {
    const ModeTransitionRow row = get_row(view.modes.transitions, index);
    return quote(to_text(row.source_name)) + " -> " + quote(to_text(row.target_name));
}

std::string describe_transition(const Finding& finding, const SystemView& view) {
    const std::string transition = "transition " + get_transition_name(view, finding.element);
    if (finding.rule == Rule::kTransitionAmbiguous) {
        return transition + " has the event of " + get_transition_name(view, finding.other);
    }
    return finding.rule == Rule::kSafeModeIsLeft ? transition + " leaves the safe mode"
                                                 : transition + " names a mode that does not exist";
}

std::string describe_mode(const Finding& finding, const SystemView& view) {
    const std::string mode = "mode " + quote(get_mode_name(view, finding.element));
    switch (finding.rule) {
        case Rule::kModeNamedTwice:
            return mode + " has the name of an earlier one";
        case Rule::kModeOfUnknownSet:
            return mode + ": there is no configuration set " +
                   quote(to_text(get_row(view.modes.modes, finding.element).set_name));
        case Rule::kModeUnreachable:
            return mode + ": no sequence of transitions leads there from mode " +
                   quote(get_mode_name(view, 0U));
        case Rule::kTwoSafeModes:
            return mode + " is a second safe mode";
        default:
            return mode + ": row " + std::to_string(finding.element) + " needs a name and a place among 32";
    }
}

}  // namespace

std::vector<std::string> describe_broken_configuration(const SystemView& view) {
    std::vector<std::string> sentences;
    for (std::size_t i = 0U; i < view.configuration.parameters.size(); ++i) {
        const ParameterRow& row = view.configuration.parameters[i];
        if (row.owner == nullptr || row.parameter == nullptr) {
            sentences.push_back("parameter '" + get_parameter_name(row) + "': row " + std::to_string(i) +
                                " needs a component and a parameter");
        }
    }
    for (std::size_t i = 0U; i < view.configuration.sets.size(); ++i) {
        if (!is_set_whole(view.configuration, view.configuration.sets[i])) {
            sentences.push_back(get_set_name(view, i) + ": row " + std::to_string(i) +
                                " needs a name, and assignments of the table with a parameter and values");
        }
    }
    return sentences;
}

std::string describe_modes(const Finding& finding, const SystemView& view) {
    const ModeMemberRow member = get_row(view.modes.members, finding.element);
    switch (finding.rule) {
        case Rule::kConfigurationRefused:
            return describe_set(finding, view);
        case Rule::kModeOfUnknownComponent:
            return "mode " + quote(get_mode_name(view, member.mode)) + " runs component " +
                   quote(member.component == nullptr ? "?" : to_text(member.component->get_name())) +
                   ", which no window runs";
        case Rule::kComponentInNoMode:
            return "component " + quote(get_component_name(view, finding.element)) + " runs in no mode";
        case Rule::kInputNotFedInMode:
            return "input " + quote(get_input_name(view, finding.element)) +
                   " is mandatory and nothing feeds it in mode " + quote(get_mode_name(view, finding.other));
        case Rule::kConnectionOfUnknownMode: {
            const ConnectionModeRow row = get_row(view.modes.connection_modes, finding.element);
            return "connection " + quote(get_connection_name(view, row.connection)) + " holds in mode " +
                   quote(to_text(row.mode_name)) + ", which does not exist";
        }
        case Rule::kTransitionOfUnknownMode:
        case Rule::kTransitionAmbiguous:
        case Rule::kSafeModeIsLeft:
            return describe_transition(finding, view);
        case Rule::kNoSafeMode:
            return "the system has modes and none of them is safe";
        case Rule::kSafeModeActivates:
            return "component " + quote(get_component_name(view, finding.element)) +
                   " runs in the safe mode but not in mode " + quote(get_mode_name(view, finding.other));
        case Rule::kModeRowInvalid:
        case Rule::kModeNamedTwice:
        case Rule::kModeOfUnknownSet:
        case Rule::kModeUnreachable:
        case Rule::kTwoSafeModes:
            return describe_mode(finding, view);
        default:
            return {};
    }
}

}  // namespace mamori::table_dump
