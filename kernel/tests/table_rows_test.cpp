// SPDX-License-Identifier: Apache-2.0
// Goal: no row of a table made at run time leads anywhere before it was judged: whatever a pointer, index,
// range or count holds, check_all() names the guilty row and the executive refuses the table.
// Method: a table with each kind of row; each such field of each row is damaged by itself, then pairs of them
// from a fixed seed. Fields that nothing follows are listed: with them the table must run.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <initializer_list>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "mamori/kernel/component/external_trigger.hpp"
#include "mamori/kernel/dataflow/queue_in_port.hpp"
#include "mamori/kernel/run/executive.hpp"
#include "mamori/kernel/run/introspection.hpp"
#include "mamori/kernel/system/system.hpp"
#include "mamori/trace/verifies.hpp"
#include "support/fake_host.hpp"

namespace mamori {
namespace {

using testing_support::FakeHost;
using namespace verification;

enum class Command { kStart, kStop };
enum class Fault : std::uint32_t { kHot, kFast };
enum class Reaction : std::uint32_t { kStop };

class Node final : public Component {
  public:
    explicit Node(const char* name) noexcept : Component(name) {}
    InPort<std::int64_t, Need::kOptional> in{*this, "in"};
    OutPort<std::int64_t> out{*this, "out"};
    using Ports = mamori::Ports<&Node::in, &Node::out>;
    Parameter<double> speed{*this, "speed", 1.0, between(0.1, 3.0)};
    using Parameters = mamori::Parameters<&Node::speed>;

    Status on_execute(ContextHandle) noexcept override {
        out.write(in.read() + 1);
        return Status::kOk;
    }
};
class Log final : public Component {
  public:
    explicit Log(const char* name) noexcept : Component(name) {}
    QueueInPort<std::int64_t, 4U> in{*this, "in"};
    using Ports = mamori::Ports<&Log::in>;
};

struct Parts {
    Node source{"source"};
    Node filter{"filter"};
    Node ticked{"ticked"};
    Node drive{"drive"};
    Log log{"log"};
    ExternalTrigger trigger;
    Crossing<std::int64_t> to_drive;
};

auto make_table(Parts& p) {
    return system(frame(1000_ns),
                  window("sense", 0_ns, 200_ns, rate(Rate{1.0e6}, Rate{0.5e6}), budget(150_ns),
                         run(worst_case(p.source, 50_ns), p.filter)),
                  window("log", 200_ns, 100_ns, event_driven(2U), budget(100_ns), run(p.log)),
                  window("tick", 300_ns, 100_ns, triggered_by(p.trigger), partition("io"), budget(100_ns),
                         run(p.ticked)),
                  window("act", 500_ns, 400_ns, core(1U), budget(300_ns), run(p.drive)),
                  connect(p.source.out, p.filter.in, any_age()), connect(p.filter.out, p.log.in, any_age()),
                  connect(p.filter.out, p.drive.in, through(p.to_drive), only_in("work", "idle"), any_age()),
                  configuration_set("slow", assign(p.drive.speed, 0.5), assign(p.source.speed, 0.5)),
                  configuration_set("fast", assign(p.drive.speed, 2.0), assign(p.source.speed, 2.0)),
                  system_mode("idle", runs(p.source, p.filter, p.log, p.drive)),
                  system_mode("work", runs(p.source, p.filter, p.log, p.drive, p.ticked), parameters("fast")),
                  safe_mode("halt", runs(p.source, p.filter, p.log, p.drive)),
                  mode_transition("idle", Command::kStart, "work"),
                  mode_transition("work", Command::kStop, "idle"), faults<Fault::kHot, Fault::kFast>(),
                  react(Fault::kHot, Reaction::kStop, within(1_ms)),
                  react(Fault::kFast, Reaction::kStop, within(2_ms)));
}

struct Rig : Parts {
    using Table = decltype(make_table(std::declval<Parts&>()));

    Table table{make_table(*this)};
    SystemModes modes{make_view(table)};
    ExecutiveFor<Table> core_0{table, modes};
    ExecutiveFor<Table> core_1{table, modes, 1U};
    IntrospectionFor<Table> introspection{table};
    FakeHost host;

    std::vector<Finding> list_findings() const {
        std::vector<Finding> findings(check_all(make_view(table), {}));
        static_cast<void>(check_all(make_view(table), {findings.data(), findings.size()}));
        return findings;
    }
    /// Ten frames on both cores, with a switch of modes in them. @return false when something was refused.
    bool run() {
        if (core_0.initialize() != Status::kOk || core_1.initialize() != Status::kOk ||
            core_0.start() != Status::kOk || core_1.start() != Status::kOk) {
            return false;
        }
        static_cast<void>(modes.request(Command::kStart));
        for (std::int64_t frame = 0; frame < 10; ++frame) {
            for (std::size_t w = 0U; w < table.windows.size(); ++w) {
                host.now = Instant{frame * 1000 + table.windows[w].offset.ns};
                Executive& executive = table.windows[w].core == 0U ? static_cast<Executive&>(core_0) : core_1;
                static_cast<void>(executive.run_window(w, host.now, host));
            }
        }
        return core_0.stop() == Status::kOk && core_1.stop() == Status::kOk;
    }
};
using Table = Rig::Table;

/// One field of one row, and a value that it must not have, or may.
struct Damage {
    std::string what;
    std::vector<Rule> rules;  ///< one of them must be found; empty: nothing follows the field
    std::size_t element{0U};  ///< the guilty row
    std::function<void(Table&)> apply;
};

/// Collects the damages of a sound table.
class Damages final {
  public:
    std::vector<Damage> list;

    /// `get(table)` refers to the field, here and below.
    template <typename Get>
    void add_null(const std::string& what, std::vector<Rule> rules, std::size_t element, Get get) {
        if (get(sound_.table) != nullptr) {
            list.push_back(
                {what + " = null", std::move(rules), element, [get](Table& t) { get(t) = nullptr; }});
        }
    }
    template <typename Value, typename Get>
    void add(const std::string& what, std::vector<Rule> rules, std::size_t element, Value value, Get get) {
        list.push_back({what + " = " + std::to_string(static_cast<std::uint64_t>(value)), std::move(rules),
                        element, [get, value](Table& t) { get(t) = value; }});
    }
    /// Beyond `size` rows by nothing, by one, and as far as it goes.
    template <typename Get>
    void add_index(const std::string& what, const std::vector<Rule>& rules, std::size_t element,
                   std::size_t size, Get get) {
        for (const std::size_t value : {size, size + 1U, kNoIndex}) {
            if (get(sound_.table) != value) {
                add(what, rules, element, value, get);
            }
        }
    }
    /// A range that holds nothing may begin at the end.
    template <typename GetFirst, typename GetCount>
    void add_range(const std::string& what, const std::vector<Rule>& rules, std::size_t element,
                   std::size_t size, GetFirst get_first, GetCount get_count) {
        const bool is_empty = get_count(sound_.table) == 0U;
        for (const std::size_t value : {size, size + 1U, kNoIndex}) {
            const bool is_free = is_empty && value == size;
            add("first of " + what, is_free ? std::vector<Rule>{} : rules, element, value, get_first);
        }
        for (const std::size_t value : {size, size + 1U, kNoIndex}) {
            if (get_count(sound_.table) != value) {
                add("count of " + what, rules, element, value, get_count);
            }
        }
    }
    /// For what depends on the table. @param[in] element row of it, here and below.
    const Table& get_table() const { return sound_.table; }

  private:
    Rig sound_;
};

std::string name(const char* kind, std::size_t row) {
    return std::string(kind) + " " + std::to_string(row) + ": ";
}

void add_windows(Damages& d) {
    const Table& t = d.get_table();
    const std::vector<Rule> invalid{Rule::kWindowRowInvalid};
    for (std::size_t w = 0U; w < t.windows.size(); ++w) {
        const auto of = [w](auto member) {
            return [w, member](auto& x) -> auto& { return x.windows[w].*member; };
        };
        const std::string at = name("window", w);
        d.add_null(at + "name", invalid, w, of(&WindowRow::name));
        d.add_null(at + "partition", invalid, w, of(&WindowRow::partition));
        d.add_null(at + "trigger", invalid, w, of(&WindowRow::trigger));
        d.add_range(at + "components", invalid, w, t.components.size(), of(&WindowRow::first_component),
                    of(&WindowRow::component_count));
        d.add(at + "components", invalid, w, std::size_t{0U}, of(&WindowRow::component_count));
        d.add_range(at + "ports", invalid, w, t.ports.size(), of(&WindowRow::first_port),
                    of(&WindowRow::port_count));
        d.add_range(at + "latches", invalid, w, t.latch_order.size(), of(&WindowRow::first_latch),
                    of(&WindowRow::latch_count));
        d.add_range(at + "parameters", invalid, w, t.configuration.parameters.size(),
                    of(&WindowRow::first_parameter), of(&WindowRow::parameter_count));
        for (const std::size_t count : {kAlternativeRateMax, kAlternativeRateMax + 1U, std::size_t{0xFFU}}) {
            d.add(at + "alternatives", {Rule::kWindowRowInvalid, Rule::kRateNotReachable}, w,
                  static_cast<std::uint8_t>(count), of(&WindowRow::alternative_count));
        }
        d.add(at + "events", invalid, w, std::uint16_t{0U}, of(&WindowRow::events_per_cycle));
        d.add(at + "kind", invalid, w, ExecutionKind{3U}, of(&WindowRow::kind));
        d.add(at + "kind", invalid, w, ExecutionKind{~0U}, of(&WindowRow::kind));
        d.add(at + "events", {}, w, std::uint16_t{0xFFFFU}, of(&WindowRow::events_per_cycle));  // in range
    }
}

void add_components(Damages& d) {
    const Table& t = d.get_table();
    const std::vector<Rule> invalid{Rule::kComponentRowInvalid};
    for (std::size_t c = 0U; c < t.components.size(); ++c) {
        const auto of = [c](auto member) {
            return [c, member](auto& x) -> auto& { return x.component_rows[c].*member; };
        };
        const std::string at = name("component", c);
        d.add_null(at + "itself", invalid, c, [c](auto& x) -> auto& { return x.components[c]; });
        d.add_index(at + "window", invalid, c, t.windows.size(), of(&ComponentRow::window));
        d.add_range(at + "ports", invalid, c, t.ports.size(), of(&ComponentRow::first_port),
                    of(&ComponentRow::port_count));
        d.add_range(at + "outgoing", invalid, c, t.outgoing_order.size(), of(&ComponentRow::first_outgoing),
                    of(&ComponentRow::outgoing_count));
        d.list.push_back({at + "worst case < 0", invalid, c,
                          [c](Table& x) { x.component_rows[c].worst_case = Duration{-1}; }});
    }
}

void add_ports(Damages& d) {
    const Table& t = d.get_table();
    const std::vector<Rule> invalid{Rule::kPortRowInvalid};
    for (std::size_t p = 0U; p < t.ports.size(); ++p) {
        const auto of = [p](auto member) {
            return [p, member](auto& x) -> auto& { return x.ports[p].*member; };
        };
        const std::string at = name("port", p);
        d.add_null(at + "owner", invalid, p, of(&PortRow::owner));
        d.add_null(at + "input", invalid, p, of(&PortRow::input));
        d.add_null(at + "output", invalid, p, of(&PortRow::output));
        d.add_null(at + "count", invalid, p, of(&PortRow::count));
        d.add_index(at + "window", invalid, p, t.windows.size(), of(&PortRow::window));
        d.add_index(at + "component", invalid, p, t.components.size(), of(&PortRow::component));
    }
}

void add_connections(Damages& d) {
    const Table& t = d.get_table();
    const std::vector<Rule> invalid{Rule::kConnectionRowInvalid};
    for (std::size_t n = 0U; n < t.connections.size(); ++n) {
        const auto of = [n](auto member) {
            return [n, member](auto& x) -> auto& { return x.connections[n].*member; };
        };
        const auto operation = [n](auto member) {
            return [n, member](auto& x) -> auto& { return x.connections[n].operations.*member; };
        };
        const std::string at = name("connection", n);
        d.add_null(at + "source", invalid, n, of(&ConnectionRow::source));
        d.add_null(at + "sink", invalid, n, of(&ConnectionRow::sink));
        d.add_null(at + "crossing", invalid, n, of(&ConnectionRow::crossing));
        d.add_null(at + "latch", invalid, n, operation(&ConnectionOperations::latch));
        d.add_null(at + "restart", invalid, n, operation(&ConnectionOperations::restart));
        // Not every connection has them.
        d.add_null(at + "deliver", {}, n, operation(&ConnectionOperations::deliver));
        d.add_null(at + "hand_on", {}, n, operation(&ConnectionOperations::hand_on));
        d.add_null(at + "note_discarded", {}, n, operation(&ConnectionOperations::note_discarded));
        d.list.push_back({at + "age limit 0", {Rule::kAgeLimitNotPositive}, n, [n](Table& x) {
                              x.connections[n].age_max = Duration{0};
                          }});
        d.add(at + "is_set", invalid, n, false, operation(&ConnectionOperations::is_set));
        d.add_index(at + "source_window", invalid, n, t.windows.size(), of(&ConnectionRow::source_window));
        d.add_index(at + "sink_window", invalid, n, t.windows.size(), of(&ConnectionRow::sink_window));
        d.add_index(at + "source_component", invalid, n, t.components.size(),
                    of(&ConnectionRow::source_component));
        d.add_index(at + "sink_component", invalid, n, t.components.size(),
                    of(&ConnectionRow::sink_component));
        const std::size_t latcher = t.connections[t.latch_order[n]].sink_window;
        d.add_index(name("latch_order", n), {Rule::kWindowRowInvalid}, latcher, t.connections.size(),
                    [n](auto& x) -> auto& { return x.latch_order[n]; });
        const std::size_t owner = t.connections[t.outgoing_order[n]].source_component;
        d.add_index(name("outgoing_order", n), {Rule::kComponentRowInvalid}, owner, t.connections.size(),
                    [n](auto& x) -> auto& { return x.outgoing_order[n]; });
    }
}

void add_modes(Damages& d) {
    const Table& t = d.get_table();
    const std::size_t mode_count = t.modes.modes.size();
    for (std::size_t m = 0U; m < mode_count; ++m) {
        const auto of = [m](auto member) {
            return [m, member](auto& x) -> auto& { return x.modes.modes[m].*member; };
        };
        d.add_null(name("mode", m) + "name", {Rule::kModeRowInvalid}, m, of(&SystemModeRow::name));
        d.add_null(name("mode", m) + "set_name", {}, m, of(&SystemModeRow::set_name));  // its place counts
        d.add_index(name("mode", m) + "set", {Rule::kModeOfUnknownSet}, m, t.configuration.sets.size(),
                    of(&SystemModeRow::set));
    }
    const std::vector<Rule> of_nobody{Rule::kModeOfUnknownComponent};
    for (std::size_t i = 0U; i < t.modes.members.size(); ++i) {
        const auto of = [i](auto member) {
            return [i, member](auto& x) -> auto& { return x.modes.members[i].*member; };
        };
        d.add_null(name("member", i) + "component", of_nobody, i, of(&ModeMemberRow::component));
        d.add_index(name("member", i) + "mode", of_nobody, i, mode_count, of(&ModeMemberRow::mode));
        d.add_index(name("member", i) + "index", of_nobody, i, t.components.size(),
                    of(&ModeMemberRow::index));
    }
    const std::vector<Rule> unknown{Rule::kTransitionOfUnknownMode};
    for (std::size_t i = 0U; i < t.modes.transitions.size(); ++i) {
        const auto of = [i](auto member) {
            return [i, member](auto& x) -> auto& { return x.modes.transitions[i].*member; };
        };
        d.add_null(name("transition", i) + "source_name", {}, i, of(&ModeTransitionRow::source_name));
        d.add_null(name("transition", i) + "target_name", {}, i, of(&ModeTransitionRow::target_name));
        d.add_index(name("transition", i) + "source", unknown, i, mode_count, of(&ModeTransitionRow::source));
        d.add_index(name("transition", i) + "target", unknown, i, mode_count, of(&ModeTransitionRow::target));
    }
    for (std::size_t i = 0U; i < t.modes.connection_modes.size(); ++i) {
        const auto of = [i](auto member) {
            return [i, member](auto& x) -> auto& { return x.modes.connection_modes[i].*member; };
        };
        const std::vector<Rule> nowhere{Rule::kConnectionOfUnknownMode};
        d.add_null(name("only_in", i) + "mode_name", {}, i, of(&ConnectionModeRow::mode_name));
        d.add_index(name("only_in", i) + "mode", nowhere, i, mode_count, of(&ConnectionModeRow::mode));
        d.add_index(name("only_in", i) + "connection", nowhere, i, t.connections.size(),
                    of(&ConnectionModeRow::connection));
    }
}

void add_configuration(Damages& d) {
    const auto& t = d.get_table().configuration;
    for (std::size_t i = 0U; i < t.parameters.size(); ++i) {
        const auto of = [i](auto member) {
            return [i, member](auto& x) -> auto& { return x.configuration.parameters[i].*member; };
        };
        d.add_null(name("parameter", i) + "owner", {Rule::kParameterRowInvalid}, i, of(&ParameterRow::owner));
        d.add_null(name("parameter", i) + "itself", {Rule::kParameterRowInvalid}, i,
                   of(&ParameterRow::parameter));
    }
    const std::vector<Rule> invalid{Rule::kSetRowInvalid};
    for (std::size_t s = 0U; s < t.sets.size(); ++s) {
        const auto of = [s](auto member) {
            return [s, member](auto& x) -> auto& { return x.configuration.sets[s].*member; };
        };
        d.add_null(name("set", s) + "name", invalid, s, of(&ConfigurationSetRow::name));
        // All assignments from the first one on are rows of the table, but they repeat parameters.
        d.add_range(name("set", s) + "assignments", {Rule::kSetRowInvalid, Rule::kConfigurationRefused}, s,
                    t.assignments.size(), of(&ConfigurationSetRow::first_assignment),
                    of(&ConfigurationSetRow::assignment_count));
    }
    for (std::size_t a = 0U; a < t.assignments.size(); ++a) {
        const auto of = [a](auto member) {
            return [a, member](auto& x) -> auto& { return x.configuration.assignments[a].*member; };
        };
        const std::size_t set = a / 2U;
        d.add_null(name("assignment", a) + "parameter", invalid, set, of(&AssignmentRow::parameter));
        d.add_range(name("assignment", a) + "values", invalid, set, t.values.size(),
                    of(&AssignmentRow::first_value), of(&AssignmentRow::value_count));
        d.add(name("assignment", a) + "values", invalid, set, std::size_t{0U},
              of(&AssignmentRow::value_count));
    }
}

std::vector<Damage> list_damages() {
    Damages damages;
    add_windows(damages);
    add_components(damages);
    add_ports(damages);
    add_connections(damages);
    add_modes(damages);
    add_configuration(damages);
    return damages.list;
}

TEST(TableRowsTest, TheSoundTableRuns) {
    verifies("SWR-KRN-025");
    Rig rig;

    EXPECT_EQ(rig.list_findings().size(), 0U);
    EXPECT_TRUE(rig.run());
    EXPECT_EQ(rig.modes.get_mode(), 1U);
}

TEST(TableRowsTest, EachPointerIndexRangeAndCountIsJudgedBeforeItIsFollowed) {
    verifies("SWR-KRN-025", Technique::kFaultInjection, Polarity::kViolation);
    std::size_t judged_count = 0U;
    for (const Damage& damage : list_damages()) {
        if (damage.rules.empty()) {
            continue;
        }
        Rig rig;
        damage.apply(rig.table);
        const std::vector<Finding> findings = rig.list_findings();

        EXPECT_TRUE(std::any_of(findings.begin(), findings.end(),
                                [&damage](const Finding& found) {
                                    return found.element == damage.element &&
                                           std::count(damage.rules.begin(), damage.rules.end(), found.rule) !=
                                               0;
                                }))
            << damage.what << ": " << findings.size() << " findings, first "
            << (findings.empty() ? "none" : get_name(findings[0].rule));
        rig.core_0.set_introspection(&rig.introspection);
        EXPECT_EQ(rig.core_0.initialize(), Status::kBadParameter) << damage.what;
        EXPECT_EQ(rig.core_1.initialize(), Status::kBadParameter) << damage.what;
        ++judged_count;
    }
    EXPECT_GT(judged_count, 400U);
}

/// Each value is one that some row might have; it does not agree with the other rows. Node n has the ports
/// 2n and 2n + 1 up to the filter (1); the log (2) has port 4.
TEST(TableRowsTest, RowsThatDisagreeAreNamedThoughEachLeadsSomewhere) {
    verifies("SWR-KRN-025", Technique::kFaultInjection, Polarity::kViolation);
    struct Case {
        const char* what;
        Rule rule;
        std::size_t element;
        void (*apply)(Rig&);
    };
    const Case cases[] = {
        {"window of a component", Rule::kComponentRowInvalid, 0U,
         [](Rig& r) { r.table.component_rows[0].window = 1U; }},
        {"owner of a port", Rule::kPortRowInvalid, 0U, [](Rig& r) { r.table.ports[0].owner = &r.log; }},
        {"window of a port", Rule::kPortRowInvalid, 0U, [](Rig& r) { r.table.ports[0].window = 1U; }},
        {"port of another component", Rule::kPortRowInvalid, 0U,
         [](Rig& r) {
             r.table.ports[0].owner = &r.filter;
             r.table.ports[0].component = 1U;
         }},
        {"ports of a component, short of one", Rule::kPortRowInvalid, 1U,
         [](Rig& r) { r.table.component_rows[0].port_count = 1U; }},
        {"ports of a window, short of one", Rule::kPortRowInvalid, 3U,
         [](Rig& r) { r.table.windows[0].port_count = 3U; }},
        {"window without outputs", Rule::kPortRowInvalid, 1U,
         [](Rig& r) { r.table.windows[0].has_outputs = false; }},
        {"window without deliveries", Rule::kConnectionRowInvalid, 1U,
         [](Rig& r) { r.table.windows[0].has_deliveries = false; }},
        {"window of a source", Rule::kConnectionRowInvalid, 0U,
         [](Rig& r) { r.table.connections[0].source_window = 1U; }},
        {"output of another component", Rule::kConnectionRowInvalid, 0U,
         [](Rig& r) { r.table.connections[0].source = &r.drive.out; }},
        {"outgoing of a component, short of one", Rule::kConnectionRowInvalid, 0U,
         [](Rig& r) { r.table.component_rows[0].outgoing_count = 0U; }},
        {"window of a sink", Rule::kConnectionRowInvalid, 0U,
         [](Rig& r) { r.table.connections[0].sink_window = 1U; }},
        {"input of another component", Rule::kConnectionRowInvalid, 0U,
         [](Rig& r) { r.table.connections[0].sink = &r.drive.in; }},
        {"latches of a window, short of one", Rule::kConnectionRowInvalid, 0U,
         [](Rig& r) { r.table.windows[0].latch_count = 0U; }},
        {"parameters of a window, short of one", Rule::kParameterRowInvalid, 1U,
         [](Rig& r) { r.table.windows[0].parameter_count = 1U; }},
    };
    for (const Case& one : cases) {
        Rig rig;
        one.apply(rig);
        const std::vector<Finding> findings = rig.list_findings();

        EXPECT_TRUE(std::any_of(
            findings.begin(), findings.end(),
            [&one](const Finding& found) { return found.rule == one.rule && found.element == one.element; }))
            << one.what << ": " << findings.size() << " findings, first "
            << (findings.empty() ? "none" : get_name(findings[0].rule));
        EXPECT_EQ(rig.core_0.initialize(), Status::kBadParameter) << one.what;
    }
}

TEST(TableRowsTest, WhatNothingFollowsDoesNoHarm) {
    verifies("SWR-KRN-025", Technique::kFaultInjection);
    for (const Damage& damage : list_damages()) {
        if (damage.rules.empty()) {
            Rig rig;
            damage.apply(rig.table);

            EXPECT_EQ(rig.list_findings().size(), 0U) << damage.what;
            EXPECT_TRUE(rig.run()) << damage.what;
        }
    }
}

TEST(TableRowsTest, PairsOfDamagesEndInARefusalOrInATableThatRuns) {
    verifies("SWR-KRN-025", Technique::kFaultInjection, Polarity::kViolation);
    const std::vector<Damage> damages = list_damages();
    std::mt19937_64 numbers{20250101U};
    for (int i = 0; i < 5000; ++i) {
        const Damage& first = damages[numbers() % damages.size()];
        const Damage& second = damages[numbers() % damages.size()];
        Rig rig;
        first.apply(rig.table);
        second.apply(rig.table);

        const bool is_sound = rig.list_findings().empty();
        EXPECT_EQ(rig.run(), is_sound) << first.what << "; " << second.what;
    }
}

}  // namespace
}  // namespace mamori
