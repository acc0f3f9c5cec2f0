// SPDX-License-Identifier: Apache-2.0
#include "write_safety.hpp"

#include <array>
#include <cstdint>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "element_names.hpp"
#include "json_text.hpp"

namespace mamori::table_dump {
namespace {

using namespace safety;  // NOLINT: rows of the safety layer
using json::format_truth;
using json::quote;

using Member = std::pair<const char*, std::string>;

/// `{"key": value, ...}`
std::string make_object(const std::vector<Member>& members) {
    const auto make = [&](std::size_t i) { return quote(members[i].first) + ": " + members[i].second; };
    std::string text = json::make_list(members.size(), make);
    text.front() = '{';
    text.back() = '}';
    return text;
}

std::string format_fault(FaultIndex fault) {
    return fault == kNoFault ? "null" : std::to_string(fault);
}

std::string format_ns(Duration time) {
    return std::to_string(time.ns);
}

std::string format_component(const SystemView& view, const Component* component) {
    std::size_t index = 0U;
    while (index < view.components.size() && view.components[index] != component) {
        ++index;
    }
    return json::format_index(index, view.components.size());
}

std::string make_supervised(const SystemView& view, const SuperviseRow& row) {
    const Checkpoints& points = row.checkpoints;
    std::size_t count = 0U;
    for (std::size_t i = 0U; points.table != nullptr && i < points.table->checkpoints.size(); ++i) {
        count += points.table->checkpoints[i].entity == points.entity ? 1U : 0U;
    }
    return make_object({{"component", format_component(view, row.watch.component)},
                        {"late_cycles", std::to_string(row.watch.limits.alive.late_cycles)},
                        {"expired_cycles", std::to_string(row.watch.limits.alive.expired_cycles)},
                        {"shortest_ns", format_ns(row.watch.limits.deadline.shortest)},
                        {"longest_ns", format_ns(row.watch.limits.deadline.longest)},
                        {"checkpoints", std::to_string(count)},
                        {"fault", format_fault(row.fault)}});
}

std::string make_confirmation(const ConfirmRow& row) {
    return make_object({{"fault", format_fault(row.fault)},
                        {"cycles", std::to_string(row.confirmation.cycles)},
                        {"decay", std::to_string(row.confirmation.decay)},
                        {"time_ns", format_ns(row.confirmation.time)},
                        {"healing_cycles", std::to_string(row.healing.cycles)},
                        {"healing_ns", format_ns(row.healing.time)}});
}

std::string make_stop_source(const SystemView& view, const StopSourceRow& row) {
    constexpr std::array<const char*, kStopConfirmationCount> kNames{"standstill", "closed_brakes",
                                                                     "torque_off"};
    std::size_t port = 0U;
    while (port < view.ports.size() && view.ports[port].output != row.port) {
        ++port;
    }
    return make_object({{"component", format_component(view, get_row(view.ports, port).owner)},
                        {"port", quote(row.port == nullptr ? "?" : to_text(row.port->get_name()))},
                        {"confirms", json::make_list(kStopConfirmationCount, [&](std::size_t i) {
                             return row.confirms[i] ? quote(kNames[i]) : std::string{};
                         })}});
}

std::string make_self_test(const SelfTestRow& row) {
    return make_object(
        {{"found_within_ns", format_ns(row.found_within)}, {"fault", format_fault(row.fault)}});
}

std::string make_protection(const SystemView& view, const ProtectRow& row) {
    return make_object({{"component", format_component(view, row.component)},
                        {"profile", std::to_string(row.profile)},
                        {"fresh_within_ns", format_ns(row.limit.age_max)},
                        {"lead_ns", format_ns(row.limit.lead_max)},
                        {"max_delta", row.max_delta == 0U ? "null" : std::to_string(row.max_delta)},
                        {"fault", format_fault(row.fault)}});
}

std::string make_assumption(const AssumptionRow& row) {
    return make_object({{"name", quote(to_text(row.name))}, {"within_ns", format_ns(row.within)}});
}

std::string make_cycle(const CycleRow& row) {
    const auto make_fault = [&](std::size_t fault) -> std::string {
        return ((row.brakes_first >> fault) & 1U) != 0U ? std::to_string(fault) : "";
    };
    return make_object({{"ss2_within_ns", format_ns(row.stops.ss2_within)},
                        {"ss1_within_ns", format_ns(row.stops.ss1_within)},
                        {"brakes_close_within_ns", format_ns(row.brakes.closes_within)},
                        {"brakes_have_contacts", format_truth(row.brakes.has_contacts)},
                        {"watchdog_shortest_ns", format_ns(row.watchdog.shortest)},
                        {"watchdog_longest_ns", format_ns(row.watchdog.longest)},
                        {"torque_feedback_ns", format_ns(row.torque_feedback)},
                        {"lateness_max_ns", format_ns(row.lateness_max)},
                        {"late_reaction_fault", format_fault(row.late_fault)},
                        {"self_test_fault", format_fault(row.self_test_fault)},
                        {"unconfirmed_brakes_fault", format_fault(row.brake_fault)},
                        {"brakes_first", json::make_list(64U, make_fault)}});
}

}  // namespace

void write_safety(std::ostream& out, const SystemView& view, const SafetyView* safety) {
    if (safety == nullptr) {
        out << ",\n \"safety\": null";
        return;
    }
    out << ",\n \"safety\": {\n \"cycle\": " << make_cycle(safety->cycle);
    json::write_rows(out, "supervised", safety->supervised.size(),
                     [&](std::size_t i) { return make_supervised(view, safety->supervised[i]); });
    json::write_rows(out, "confirmations", safety->confirmations.size(),
                     [&](std::size_t i) { return make_confirmation(safety->confirmations[i]); });
    json::write_rows(out, "stop_sources", safety->stop_sources.size(),
                     [&](std::size_t i) { return make_stop_source(view, safety->stop_sources[i]); });
    json::write_rows(out, "self_tests", safety->self_tests.size(),
                     [&](std::size_t i) { return make_self_test(safety->self_tests[i]); });
    json::write_rows(out, "protections", safety->protections.size(),
                     [&](std::size_t i) { return make_protection(view, safety->protections[i]); });
    json::write_rows(out, "assumptions", safety->assumptions.size(),
                     [&](std::size_t i) { return make_assumption(safety->assumptions[i]); });
    out << "\n }";
}

}  // namespace mamori::table_dump
