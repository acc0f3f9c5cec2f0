// SPDX-License-Identifier: Apache-2.0
#include "write_modes.hpp"

#include <utility>
#include <vector>

#include "element_names.hpp"
#include "json_text.hpp"

namespace mamori::table_dump {
namespace {

using json::format_index;
using json::format_truth;
using json::make_list;
using json::quote;

bool is_in(ModeMask modes, std::size_t mode) {
    return mode < kSystemModeMax && (modes & to_mask(mode)) != 0U;
}

/// A row and its name; either may be missing.
std::string make_reference(const std::string& name, std::size_t index, std::size_t count) {
    return "{\"index\": " + format_index(index, count) + ", \"name\": " + quote(name) + "}";
}

/// Uses the own name of the row if the referring row has none.
template <typename Row>
std::string make_named_reference(const char* name, std::size_t index, Span<const Row> rows) {
    return make_reference(to_text(name != nullptr ? name : get_row(rows, index).name), index, rows.size());
}

std::string make_mode(const SystemView& view, std::size_t mode) {
    const SystemModeRow& row = view.modes.modes[mode];
    // Lists running components as the executive sees them. A member outside all windows has no index.
    const std::size_t component_count = view.components.size();
    const std::string components =
        make_list(component_count + view.modes.members.size(), [&](std::size_t i) -> std::string {
            if (i < component_count) {
                const bool runs = i < view.component_rows.size() && is_in(view.component_rows[i].modes, mode);
                return runs ? std::to_string(i) : "";
            }
            const ModeMemberRow& member = view.modes.members[i - component_count];
            return member.mode == mode && member.index >= component_count ? "null" : "";
        });
    const bool has_set = row.set_name != nullptr || row.set != kNoIndex;
    return "{\"name\": " + quote(to_text(row.name)) + ", \"safe\": " + format_truth(row.is_safe) +
           ", \"initial\": " + format_truth(mode == 0U) + ", \"components\": " + components + ", \"set\": " +
           (has_set ? make_named_reference(row.set_name, row.set, view.configuration.sets) : "null") + "}";
}

std::string make_transition(const SystemView& view, const Names& names, std::size_t index) {
    const ModeTransitionRow& row = view.modes.transitions[index];
    return "{\"from\": " + make_named_reference(row.source_name, row.source, view.modes.modes) +
           ", \"event\": " + std::to_string(row.event) +
           ", \"event_name\": " + json::quote_enumerator(names.events, row.event) +
           ", \"to\": " + make_named_reference(row.target_name, row.target, view.modes.modes) + "}";
}

std::string format_scalar(const Scalar& value) {
    if (value.is_real) {
        return json::format_number(value.real);
    }
    const bool is_below_zero = value.whole.is_negative && value.whole.magnitude != 0U;
    return (is_below_zero ? "-" : "") + std::to_string(value.whole.magnitude);
}

std::string format_values(Span<const Scalar> values) {
    return make_list(values.size(), [&](std::size_t i) { return format_scalar(values[i]); });
}

/// One range in the notation of the RTC Profile.
std::string format_range(const ScalarRange& range) {
    const std::string lower = format_scalar(range.lower);
    const std::string upper = format_scalar(range.upper);
    if (range.has_lower && range.has_upper) {
        return lower + (range.is_lower_open ? "<x" : "<=x") + (range.is_upper_open ? "<" : "<=") + upper;
    }
    if (range.has_lower) {
        return (range.is_lower_open ? "x>" : "x>=") + lower;
    }
    return range.has_upper ? (range.is_upper_open ? "x<" : "x<=") + upper : "";
}

/// The constraint of one element, or of each, starting at its first range. @return also the range after it.
std::pair<std::string, std::size_t> format_element(const ParameterBase& parameter, std::size_t first) {
    const ScalarRange range = parameter.get_range(first).get_value();
    std::string choices = format_scalar(range.lower);
    std::size_t next = first + 1U;
    for (; parameter.get_range(next).has_value(); ++next) {
        const ScalarRange other = parameter.get_range(next).get_value();
        if (other.element != range.element) {
            break;
        }
        choices += "," + format_scalar(other.lower);
    }
    if (next > first + 1U) {
        return {"(" + choices + ")", next};
    }
    const bool is_one_value = choices == format_scalar(range.upper);
    return {is_one_value ? choices : format_range(range), next};
}

/// A constraint in the canonical form of the notation of the RTC Profile. An invalid constraint gets a text
/// that the reader rejects.
std::string format_constraint(const ParameterBase& parameter) {
    if (!parameter.is_valid()) {
        return "invalid";
    }
    auto [text, next] = format_element(parameter, 0U);
    while (parameter.get_range(next).has_value()) {
        const auto [element, after] = format_element(parameter, next);
        text += "," + element;
        next = after;
    }
    return text;
}

std::string make_parameter(const SystemView& view, std::size_t index) {
    const ParameterRow& row = view.configuration.parameters[index];
    std::size_t owner = 0U;
    while (owner < view.components.size() && view.components[owner] != row.owner) {
        ++owner;
    }
    const std::string reference =
        make_reference(row.owner == nullptr ? "?" : to_text(row.owner->get_name()),
                       row.owner == nullptr ? kNoIndex : owner, view.components.size());
    if (row.parameter == nullptr) {
        return "{\"owner\": " + reference +
               ", \"name\": \"?\", \"type\": null, \"constraint\": \"\", \"values\": null}";
    }
    std::vector<Scalar> values(row.parameter->get_element_count());
    // There is storage for each element, which is the only precondition of reading.
    static_cast<void>(row.parameter->read({values.data(), values.size()}));
    const bool is_real = !values.empty() && values[0].is_real;
    return "{\"owner\": " + reference + ", \"name\": " + quote(to_text(row.parameter->get_name())) +
           ", \"type\": \"" + (is_real ? "real" : "whole") +
           "\", \"constraint\": " + quote(format_constraint(*row.parameter)) +
           ", \"values\": " + format_values({values.data(), values.size()}) + "}";
}

std::string make_assignment(const SystemView& view, const AssignmentRow& row) {
    const ConfigurationView& configuration = view.configuration;
    std::size_t parameter = 0U;
    while (parameter < configuration.parameters.size() &&
           configuration.parameters[parameter].parameter != row.parameter) {
        ++parameter;
    }
    const bool is_named = row.parameter != nullptr;
    return "{\"parameter\": " +
           make_reference(is_named ? to_text(row.parameter->get_name()) : "?",
                          is_named ? parameter : kNoIndex, configuration.parameters.size()) +
           ", \"values\": " +
           (has_range(configuration.values, row.first_value, row.value_count)
                ? format_values(configuration.get_values(row))
                : "null") +
           "}";
}

std::string make_set(const SystemView& view, std::size_t index) {
    const ConfigurationView& configuration = view.configuration;
    const ConfigurationSetRow& row = configuration.sets[index];
    std::string assignments{"null"};
    if (has_range(configuration.assignments, row.first_assignment, row.assignment_count)) {
        const Span<const AssignmentRow> rows = configuration.get_assignments(row);
        assignments = make_list(rows.size(), [&](std::size_t i) { return make_assignment(view, rows[i]); });
    }
    return "{\"name\": " + quote(to_text(row.name)) + ", \"assignments\": " + assignments + "}";
}

}  // namespace

std::string make_modes_of(const SystemView& view, ModeMask modes) {
    return make_list(view.modes.modes.size(), [&](std::size_t mode) -> std::string {
        return is_in(modes, mode) ? std::to_string(mode) : "";
    });
}

std::string make_only_in(const SystemView& view, std::size_t connection) {
    const Span<const ConnectionModeRow> rows = view.modes.connection_modes;
    const std::string modes = make_list(rows.size(), [&](std::size_t i) -> std::string {
        return rows[i].connection == connection ? format_index(rows[i].mode, view.modes.modes.size()) : "";
    });
    return modes == "[]" ? "null" : modes;
}

void write_modes(std::ostream& out, const SystemView& view, const Names& names) {
    json::write_rows(out, "modes", view.modes.modes.size(),
                     [&](std::size_t i) { return make_mode(view, i); });
    json::write_rows(out, "transitions", view.modes.transitions.size(),
                     [&](std::size_t i) { return make_transition(view, names, i); });
    json::write_rows(out, "parameters", view.configuration.parameters.size(),
                     [&](std::size_t i) { return make_parameter(view, i); });
    json::write_rows(out, "configuration_sets", view.configuration.sets.size(),
                     [&](std::size_t i) { return make_set(view, i); });
}

}  // namespace mamori::table_dump
