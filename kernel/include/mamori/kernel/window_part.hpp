// SPDX-License-Identifier: Apache-2.0
/// @file
/// The words that describe one window: its place in the frame, its components, and what it may take.
///
/// @satisfies SWR-KRN-017      Design: docs/design/kernel.md#system-table
#ifndef MAMORI_KERNEL_WINDOW_PART_HPP
#define MAMORI_KERNEL_WINDOW_PART_HPP

#include <array>
#include <cstddef>
#include <type_traits>

#include "mamori/kernel/parameter_list.hpp"
#include "mamori/kernel/part_types.hpp"
#include "mamori/kernel/system_table.hpp"

namespace mamori {

/// Ports of a component, as pointers to its members; a component without the alias has no ports:
///     using Ports = mamori::Ports<&Monitor::joints, &Monitor::verdict>;
template <auto... kMembers>
struct Ports {
    static constexpr std::size_t kCount = sizeof...(kMembers);
};

/// One port of a component type, as a compiler message shows it.
template <typename C, auto kMember>
struct PortMember {
    static constexpr auto kPointer = kMember;
    using Owner = C;
};

/// A component with its declared execution time.
template <typename C>
struct TimedComponent {
    C& component;
    Duration worst_case;
};
/// Declares what `component` takes at most in one cycle, both passes together; the table is refused when the
/// sum of a window is over its budget. A declaration, not a measurement. @param[in] duration > 0.
template <typename C>
constexpr TimedComponent<C> worst_case(C& component, Duration duration) noexcept {
    return {component, duration};
}

namespace detail {

template <typename C, typename = void>
struct PortsOf {
    using Type = Ports<>;
};
template <typename C>
struct PortsOf<C, std::void_t<typename C::Ports>> {
    using Type = typename C::Ports;
};

template <typename C, typename List>
struct PortMembers;
template <typename C, auto... kMembers>
struct PortMembers<C, Ports<kMembers...>> {
    using Type = TypeList<PortMember<C, kMembers>...>;
};

/// What a component of type C brings into the table.
template <typename C>
struct ComponentTypes {
    using Type = C;
    using PortList = typename PortMembers<C, typename PortsOf<C>::Type>::Type;
    static constexpr std::size_t kPortCount = PortList::kSize;
    static constexpr std::size_t kParameterCount = parameter_count<C>();
    /// An inherited member pointer has the type of the base: the component does not override the action. Of a
    /// type that is not final nobody knows what a derived one does.
    static constexpr bool kHasSecondPass =
        !std::is_final_v<C> ||
        !std::is_same_v<decltype(&C::on_state_update), decltype(&Component::on_state_update)>;
};
template <typename C>
struct ComponentTypes<TimedComponent<C>> : ComponentTypes<C> {};

template <typename C, typename Port>
constexpr PortRow make_port_row(C& component, Port& port) noexcept {
    PortRow row{};
    row.owner = &component;
    if constexpr (std::is_base_of_v<OutPortBase, Port>) {
        row.output = &port;
    } else {
        static_assert(std::is_base_of_v<InPortBase, Port>, "Ports<...> names members that are ports");
        row.input = &port;
        row.is_mandatory = Port::kIsMandatory;
        if constexpr (Port::kIsQueue) {
            row.count_queue = &Port::count;
        }
    }
    return row;
}

}  // namespace detail

/// The components of one window in execution order; they form one execution context.
template <typename... Cs>
struct RunList {
    static constexpr std::size_t kPortCount = (detail::ComponentTypes<Cs>::kPortCount + ... + 0U);
    static constexpr std::size_t kParameterCount = (detail::ComponentTypes<Cs>::kParameterCount + ... + 0U);

    std::array<Component*, sizeof...(Cs)> components{};
    std::array<Duration, sizeof...(Cs)> worst_cases{};
    std::array<std::size_t, sizeof...(Cs)> port_counts{};
    std::array<PortRow, kPortCount> ports{};
    ParameterList<kParameterCount> parameters{};
};

namespace detail {

/// Fills a RunList component by component.
template <typename List>
struct RunListBuilder {
    List list{};
    std::size_t component_count{0U};
    std::size_t port_count{0U};
    std::size_t parameter_count{0U};

    template <typename C>
    constexpr void add(const TimedComponent<C>& part) noexcept {
        list.components[component_count] = &part.component;
        list.worst_cases[component_count] = part.worst_case;
        list.port_counts[component_count] = ComponentTypes<C>::kPortCount;
        ++component_count;
        add_ports(part.component, typename PortsOf<C>::Type{});
        append_parameters_of(part.component, list.parameters, parameter_count);
    }
    template <typename C, auto... kMembers>
    constexpr void add_ports(C& component, Ports<kMembers...>) noexcept {
        static_cast<void>(component);
        ((list.ports[port_count++] = make_port_row(component, component.*kMembers)), ...);
    }
};

template <typename C>
constexpr TimedComponent<C> as_timed(C& component) noexcept {
    return {component, Duration{0}};
}
template <typename C>
constexpr TimedComponent<C> as_timed(TimedComponent<C>& component) noexcept {
    return component;
}

}  // namespace detail

/// Components in the order in which they run, each as itself or with its worst_case().
template <typename... Cs>
constexpr RunList<std::remove_const_t<std::remove_reference_t<Cs>>...> run(Cs&&... components) noexcept {
    static_assert(sizeof...(Cs) > 0U, "a window runs at least one component");
    detail::RunListBuilder<RunList<std::remove_const_t<std::remove_reference_t<Cs>>...>> builder{};
    (builder.add(detail::as_timed(components)), ...);
    return builder.list;
}

struct Budget {
    Duration limit;
};
/// Execution time that all components of a window may use together, counted from its opening.
constexpr Budget budget(Duration limit) noexcept {
    return {limit};
}

struct Every {
    Duration period;
};
/// Opens the window again after each `period`, which must divide the frame; without it: once per frame.
constexpr Every every(Duration period) noexcept {
    return {period};
}

/// Cycles per second.
struct Rate {
    double hz;
};
inline namespace literals {
constexpr Rate operator""_hz(unsigned long long value) noexcept {
    return {static_cast<double>(value)};
}
constexpr Rate operator""_hz(long double value) noexcept {
    return {static_cast<double>(value)};
}
}  // namespace literals

template <std::size_t kCount>
struct Rates {
    std::array<Rate, kCount> values;
};
/// Declares the rate of the window, which must be that of its openings, and up to four slower ones between
/// which ExecutionContext::set_rate() may choose; each must divide the first without rest.
template <typename... Alternatives>
constexpr Rates<1U + sizeof...(Alternatives)> rate(Rate first, Alternatives... slower) noexcept {
    static_assert(sizeof...(Alternatives) <= kAlternativeRateMax,
                  "a window declares at most four slower rates");
    return {{{first, slower...}}};
}

struct Core {
    std::size_t index;
};
/// Processor core that runs the window; without it: core 0. Cores share the frame and its start.
constexpr Core core(std::size_t index) noexcept {
    return {index};
}

struct Partition {
    const char* name;
};
/// Memory partition that the components of the window live in; without it all share one. Values leave it
/// only through a Crossing or a queue. @param[in] name static storage.
constexpr Partition partition(const char* name) noexcept {
    return {name};
}

struct TriggeredBy {
    ExternalTrigger& trigger;
};
/// The cycles of the window come with the ticks of `trigger`, one at most per opening (kind OTHER).
constexpr TriggeredBy triggered_by(ExternalTrigger& trigger) noexcept {
    return {trigger};
}

struct EventDriven {
    std::size_t events_per_cycle;
};
/// The window serves the events of its state machines (kind EVENT_DRIVEN).
/// @param[in] events_per_cycle upper bound for each of them in one opening, >= 1.
constexpr EventDriven event_driven(std::size_t events_per_cycle) noexcept {
    return {events_per_cycle};
}

/// One window of the description.
template <typename... Cs>
struct WindowPart {
    struct Types : detail::NoTypes {
        using Components = detail::TypeList<typename detail::ComponentTypes<Cs>::Type...>;
        using Ports = typename detail::Concat<typename detail::ComponentTypes<Cs>::PortList...>::Type;
        static constexpr std::size_t kWindows = 1U;
        static constexpr std::size_t kParameters = RunList<Cs...>::kParameterCount;
    };
    WindowRow row{};
    RunList<Cs...> list{};
};

namespace detail {

/// Period whose rate is `value`, to the nearest nanosecond; 0 for a rate that is no positive number.
constexpr Duration to_period(Rate value) noexcept {
    return value.hz > 0.0 && value.hz <= 1.0e9 ? Duration{static_cast<std::int64_t>(1.0e9 / value.hz + 0.5)}
                                               : Duration{0};
}

constexpr void apply(WindowRow& row, Budget option) noexcept {
    row.budget = option.limit;
}
constexpr void apply(WindowRow& row, Every option) noexcept {
    row.period = option.period;
}
constexpr void apply(WindowRow& row, Core option) noexcept {
    row.core = option.index;
}
constexpr void apply(WindowRow& row, Partition option) noexcept {
    row.partition = option.name;
}
constexpr void apply(WindowRow& row, TriggeredBy option) noexcept {
    row.kind = ExecutionKind::kOther;
    row.trigger = &option.trigger;
}
constexpr void apply(WindowRow& row, EventDriven option) noexcept {
    row.kind = ExecutionKind::kEventDriven;
    row.events_per_cycle = option.events_per_cycle;
}
template <std::size_t kCount>
constexpr void apply(WindowRow& row, const Rates<kCount>& option) noexcept {
    row.rate_hz = option.values[0].hz;
    row.alternative_count = kCount - 1U;
    for (std::size_t i = 1U; i < kCount; ++i) {
        row.alternative_periods[i - 1U] = to_period(option.values[i]);
    }
}

template <typename... Cs>
constexpr WindowPart<Cs...> finish_window(const WindowRow& row, const RunList<Cs...>& list) noexcept {
    WindowPart<Cs...> part{row, list};
    part.row.has_second_pass = (ComponentTypes<Cs>::kHasSecondPass || ...);
    return part;
}
template <typename Option, typename... Options>
constexpr auto finish_window(WindowRow row, const Option& option, const Options&... options) noexcept {
    static_assert(sizeof...(Options) > 0U, "a window ends with run(...)");
    apply(row, option);
    return finish_window(row, options...);
}

}  // namespace detail

/// One window: opens `offset` after the start of its period, closes `length` later.
/// @param[in] name    static storage; shown by the compiler and in every report.
/// @param[in] options budget(...) and, last, run(...); also every(...), rate(...), core(...), partition(...),
///                     triggered_by(...), event_driven(...).
template <typename... Options>
constexpr auto window(const char* name, Duration offset, Duration length,
                      const Options&... options) noexcept {
    static_assert((std::is_same_v<Options, Budget> || ...), "a window needs its budget(...)");
    WindowRow row{};
    row.name = name;
    row.offset = offset;
    row.length = length;
    return detail::finish_window(row, options...);
}

}  // namespace mamori

#endif  // MAMORI_KERNEL_WINDOW_PART_HPP
