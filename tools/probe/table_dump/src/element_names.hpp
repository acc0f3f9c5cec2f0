// SPDX-License-Identifier: Apache-2.0
/// @file
/// Readable names of the elements of a table, for any row contents.
#ifndef MAMORI_TABLE_DUMP_SRC_ELEMENT_NAMES_HPP
#define MAMORI_TABLE_DUMP_SRC_ELEMENT_NAMES_HPP

#include <cstddef>
#include <string>

#include "mamori/kernel/table/system_finding.hpp"
#include "mamori/kernel/table/system_table.hpp"

namespace mamori::table_dump {

inline std::string to_text(const char* name) {
    return name == nullptr ? "?" : name;
}

/// Element `index` of `rows`, or `otherwise` if the table has no such row.
template <typename Row>
Row get_row(Span<const Row> rows, std::size_t index, Row otherwise = {}) {
    return index < rows.size() ? rows[index] : otherwise;
}

/// Whether these rows exist.
template <typename Row>
bool has_range(Span<const Row> rows, std::size_t first, std::size_t count) {
    return first <= rows.size() && count <= rows.size() - first;
}

inline std::string get_window_name(const SystemView& view, std::size_t index) {
    return to_text(get_row(view.windows, index).name);
}

inline std::string get_component_name(const SystemView& view, std::size_t index) {
    const Component* component = index < view.components.size() ? view.components[index] : nullptr;
    return component == nullptr ? "?" : to_text(component->get_name());
}

inline std::string get_port_name(const PortRow& row) {
    return row.input != nullptr ? to_text(row.input->get_name())
                                : (row.output != nullptr ? to_text(row.output->get_name()) : "?");
}

/// `component.port`
inline std::string get_input_name(const SystemView& view, std::size_t port) {
    const PortRow row = get_row(view.ports, port);
    return (row.owner == nullptr ? "?" : to_text(row.owner->get_name())) + "." + get_port_name(row);
}

/// Member of component `finding.element` that follows `finding.other` other members in construction order.
inline std::string get_unlisted_name(const SystemView& view, const Finding& finding, MemberKind kind) {
    const Component* component =
        finding.element < view.components.size() ? view.components[finding.element] : nullptr;
    const Member* member = component == nullptr ? nullptr : component->get_first(kind);
    for (std::size_t i = 0U; i < finding.other && member != nullptr; ++i) {
        member = member->get_next();
    }
    return member == nullptr ? "?" : to_text(member->get_name());
}

/// `component.port -> component.port`
inline std::string get_connection_name(const SystemView& view, std::size_t connection) {
    const ConnectionRow row = get_row(view.connections, connection);
    return get_component_name(view, row.source_component) + "." +
           (row.source == nullptr ? "?" : to_text(row.source->get_name())) + " -> " +
           get_component_name(view, row.sink_component) + "." +
           (row.sink == nullptr ? "?" : to_text(row.sink->get_name()));
}

/// `component.parameter`
inline std::string get_parameter_name(const SystemView& view, std::size_t parameter) {
    const ParameterRow row = get_row(view.configuration.parameters, parameter);
    return (row.owner == nullptr ? "?" : to_text(row.owner->get_name())) + "." +
           (row.parameter == nullptr ? "?" : to_text(row.parameter->get_name()));
}

inline std::string get_mode_name(const SystemView& view, std::size_t index) {
    return to_text(get_row(view.modes.modes, index).name);
}

/// In the largest unit without a fraction, for example `300 us`.
inline std::string format(Duration time) {
    if (time.ns % 1'000'000'000 == 0 && time.ns != 0) {
        return std::to_string(time.ns / 1'000'000'000) + " s";
    }
    if (time.ns % 1'000'000 == 0 && time.ns != 0) {
        return std::to_string(time.ns / 1'000'000) + " ms";
    }
    if (time.ns % 1'000 == 0 && time.ns != 0) {
        return std::to_string(time.ns / 1'000) + " us";
    }
    return std::to_string(time.ns) + " ns";
}

}  // namespace mamori::table_dump

#endif  // MAMORI_TABLE_DUMP_SRC_ELEMENT_NAMES_HPP
