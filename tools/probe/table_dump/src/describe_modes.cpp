// SPDX-License-Identifier: Apache-2.0
#include "describe_modes.hpp"

#include "element_names.hpp"

namespace mamori::table_dump {
namespace {

std::string get_set_name(const SystemView& view, std::size_t index) {
    return "configuration set " + quote(to_text(get_row(view.configuration.sets, index).name));
}

std::string describe_set(const Finding& finding, const SystemView& view) {
    const std::string set = get_set_name(view, finding.element);
    switch (check(view.configuration).rule) {
        case ConfigurationRule::kSetNamedTwice:
            return set + " has the name of an earlier one";
        case ConfigurationRule::kUnknownParameter:
            return set + ": assignment " + std::to_string(finding.other) +
                   " names a parameter of no component that a window runs";
        case ConfigurationRule::kParameterAssignedTwice:
            return set + ": assignment " + std::to_string(finding.other) + " repeats a parameter";
        case ConfigurationRule::kParameterRowInvalid:
        case ConfigurationRule::kSetRowInvalid:
            return set + " cannot be checked: a row of the configuration is invalid";
        case ConfigurationRule::kValueOutsideConstraint:
        case ConfigurationRule::kNone:
            break;
    }
    return set + ": the value of assignment " + std::to_string(finding.other) +
           " is not permitted for its parameter";
}

/// `'idle' -> 'work'`, in the spelling of the transition.
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
            return mode + ": row " + std::to_string(finding.element) + " is invalid";
    }
}

}  // namespace

std::string describe_modes(const Finding& finding, const SystemView& view) {
    const ModeMemberRow member = get_row(view.modes.members, finding.element);
    switch (finding.rule) {
        case Rule::kParameterRowInvalid:
            return "parameter " + quote(get_parameter_name(view, finding.element)) + ": row " +
                   std::to_string(finding.element) + " is invalid";
        case Rule::kSetRowInvalid:
            return get_set_name(view, finding.element) + ": row " + std::to_string(finding.element) +
                   " is invalid, with assignment " + std::to_string(finding.other);
        case Rule::kConfigurationRefused:
            return describe_set(finding, view);
        case Rule::kModeOfUnknownComponent:
            return "mode " + quote(get_mode_name(view, member.mode)) + " runs component " +
                   quote(member.component == nullptr ? "?" : to_text(member.component->get_name())) +
                   (member.mode < view.modes.modes.size() ? ", which no window runs"
                                                          : ", but does not exist");
        case Rule::kComponentInNoMode:
            return "component " + quote(get_component_name(view, finding.element)) + " runs in no mode";
        case Rule::kInputNotFedInMode:
            return "input " + quote(get_input_name(view, finding.element)) +
                   " is mandatory and has no connection in mode " + quote(get_mode_name(view, finding.other));
        case Rule::kConnectionOfUnknownMode: {
            const ConnectionModeRow row = get_row(view.modes.connection_modes, finding.element);
            return "connection " + quote(get_connection_name(view, row.connection)) + " holds in mode " +
                   quote(to_text(row.mode_name)) +
                   (row.connection < view.connections.size() ? ", which does not exist"
                                                             : ", but does not exist");
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
