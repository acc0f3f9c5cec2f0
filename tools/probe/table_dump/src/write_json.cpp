// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <ostream>

#include "element_names.hpp"
#include "json_text.hpp"
#include "mamori/table_dump/table_dump.hpp"
#include "write_modes.hpp"
#include "write_safety.hpp"

namespace mamori::table_dump {
namespace {

using json::format_index;
using json::format_number;
using json::format_truth;
using json::quote;
using json::quote_enumerator;
using json::write_rows;

constexpr const char* kSchema = "mamori.table/5";

const char* get_kind(const WindowRow& row) {
    switch (row.kind) {
        case ExecutionKind::kPeriodic:
            return row.is_system ? "system" : "periodic";
        case ExecutionKind::kEventDriven:
            return "event_driven";
        case ExecutionKind::kOther:
            return "triggered";
    }
    return "invalid";
}

std::string make_window(const SystemView& view, std::size_t index) {
    const WindowRow& row = view.windows[index];
    std::string slower;
    for (std::size_t i = 0U; i < std::min<std::size_t>(row.alternative_count, kAlternativeRateMax); ++i) {
        slower += (i == 0U ? "" : ", ") + std::to_string(row.alternative_periods[i].ns);
    }
    return "{\"name\": " + quote(to_text(row.name)) + ", \"core\": " + std::to_string(row.core) +
           ", \"background_of\": " + (is_background(row) ? std::to_string(row.background_of) : "null") +
           ", \"partition\": " + quote(to_text(row.partition)) + ", \"kind\": \"" + get_kind(row) +
           "\", \"offset_ns\": " + std::to_string(row.offset.ns) +
           ", \"length_ns\": " + std::to_string(row.length.ns) +
           ", \"period_ns\": " + std::to_string(row.period.ns) +
           ", \"budget_ns\": " + std::to_string(get_declared_budget(row).ns) +
           ", \"rate_hz\": " + (row.has_rate ? format_number(row.rate_hz) : "null") +
           ", \"slower_periods_ns\": [" + slower + "], \"events_per_cycle\": " +
           (row.kind == ExecutionKind::kEventDriven ? std::to_string(row.events_per_cycle) : "null") + "}";
}

std::string make_component(const SystemView& view, std::size_t index) {
    const ComponentRow row = get_row(view.component_rows, index);
    std::string ports;
    for (std::size_t i = 0U; i < view.ports.size(); ++i) {
        const PortRow& port = view.ports[i];
        if (port.owner != view.components[index] || port.owner == nullptr || port.component != index) {
            continue;
        }
        ports += (ports.empty() ? "" : ", ") + ("{\"name\": " + quote(get_port_name(port))) +
                 ", \"direction\": \"" + (port.input != nullptr ? "in" : "out") +
                 "\", \"mandatory\": " + format_truth(port.is_mandatory) + ", \"payload_bytes\": " +
                 (port.payload_bytes == 0U ? "null" : std::to_string(port.payload_bytes)) + "}";
    }
    return "{\"name\": " + quote(get_component_name(view, index)) +
           ", \"window\": " + format_index(row.window, view.windows.size()) +
           ", \"worst_case_ns\": " + (row.worst_case.ns == 0 ? "null" : std::to_string(row.worst_case.ns)) +
           ", \"ports\": [" + ports + "]}";
}

/// Exact up to 2^53 ns; sums for invalid rows do not overflow.
double to_number(Duration time) {
    return static_cast<double>(time.ns);
}

/// When the sink reads the value that its source wrote in the first window instance of a major frame.
const char* get_way(const SystemView& view, const ConnectionRow& row) {
    if (row.operations.is_set && !row.operations.is_latest) {
        return "queue";
    }
    if (row.crossing != nullptr) {
        return "crossing";
    }
    if (row.is_forward_in_window) {
        return "same_window";
    }
    const WindowRow source = get_row(view.windows, row.source_window);
    const WindowRow sink = get_row(view.windows, row.sink_window);
    const double close = to_number(source.offset) + to_number(source.length);
    const double last_opening = to_number(sink.offset) + to_number(view.frame) - to_number(sink.period);
    return close <= last_opening ? "later_window" : "next_frame";
}

std::string make_end(const SystemView& view, std::size_t component, const char* port) {
    return "{\"component\": " + format_index(component, view.components.size()) +
           ", \"port\": " + quote(to_text(port)) + "}";
}

std::string make_connection(const SystemView& view, std::size_t index) {
    const ConnectionRow& row = view.connections[index];
    return "{\"from\": " +
           make_end(view, row.source_component, row.source == nullptr ? nullptr : row.source->get_name()) +
           ", \"to\": " +
           make_end(view, row.sink_component, row.sink == nullptr ? nullptr : row.sink->get_name()) +
           ", \"way\": \"" + get_way(view, row) + "\", \"fresh_within_ns\": " +
           (row.age_max == kNoAgeLimit ? "null" : std::to_string(row.age_max.ns)) +
           ", \"only_in\": " + make_only_in(view, index) +
           ", \"modes\": " + make_modes_of(view, row.get_modes()) + "}";
}

std::string make_reaction(const SystemView& view, const Names& names, std::size_t index) {
    const ReactionRow& row = view.reactions[index];
    return "{\"fault\": " + std::to_string(row.fault) +
           ", \"reaction\": " + quote_enumerator(names.reactions, row.reaction) +
           ", \"within_ns\": " + std::to_string(row.within.ns) +
           ", \"modes\": " + make_modes_of(view, row.modes) + "}";
}

}  // namespace

void write_json(std::ostream& out, const SystemView& view, const Names& names,
                const safety::SafetyView* safety) {
    const std::vector<std::string> findings = describe_all(view);
    Names used = names;
    if (safety != nullptr) {
        used.reactions.clear();
        for (std::uint32_t i = 0U; i <= static_cast<std::uint32_t>(safety::Reaction::kSto); ++i) {
            used.reactions.emplace_back(get_name(static_cast<safety::Reaction>(i)));
        }
    }
    out << "{\"schema\": \"" << kSchema << "\",\n \"frame_ns\": " << std::to_string(view.frame.ns)
        << ",\n \"abort_policy\": \""
        << (view.abort_policy == AbortPolicy::kSpecOnly ? "spec_only" : "openrtm_compat") << '"';
    write_rows(out, "windows", view.windows.size(), [&](std::size_t i) { return make_window(view, i); });
    write_rows(out, "components", view.components.size(),
               [&](std::size_t i) { return make_component(view, i); });
    write_rows(out, "connections", view.connections.size(),
               [&](std::size_t i) { return make_connection(view, i); });
    write_rows(out, "faults", view.faults.size(), [&](std::size_t i) {
        return "{\"number\": " + std::to_string(view.faults[i].fault) +
               ", \"name\": " + quote_enumerator(names.faults, view.faults[i].fault) + "}";
    });
    write_rows(out, "reactions", view.reactions.size(),
               [&](std::size_t i) { return make_reaction(view, used, i); });
    write_safety(out, view, safety);
    write_modes(out, view, names);
    write_rows(out, "findings", findings.size(), [&](std::size_t i) { return quote(findings[i]); });
    out << "\n}\n";
}

std::string save_json(const std::string& path, const SystemView& view, const Names& names,
                      const safety::SafetyView* safety) {
    const std::string partial = path + ".part";
    std::error_code error;
    if (std::filesystem::is_directory(path, error)) {
        return path + ": is a folder; name the file for the table itself";
    }
    {
        std::ofstream out{partial, std::ios::binary};
        write_json(out, view, names, safety);
        out.flush();
        if (out) {
            out.close();
            std::filesystem::rename(partial, path, error);
            if (!error) {
                return {};
            }
        }
    }
    std::filesystem::remove(partial, error);
    return path + ": the table cannot be written; check the folder, its permissions and the free space";
}

}  // namespace mamori::table_dump
