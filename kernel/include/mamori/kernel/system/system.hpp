// SPDX-License-Identifier: Apache-2.0
/// @file
/// Description of a system: cores with windows, components, connections, faults and reactions. It is one
/// compile-time constant, which MAMORI_CHECK makes the compiler check.
///
///     static constexpr auto kSystem = mamori::system(
///         mamori::frame(10_ms),
///         mamori::window("sense", 0_us, 200_us, mamori::every(1_ms), mamori::rate(1000_hz),
///                        mamori::budget(150_us), mamori::run(encoder, mamori::worst_case(monitor, 40_us))),
///         mamori::window("plan", 1200_us, 8_ms, mamori::core(1), mamori::budget(7_ms),
///                        mamori::run(planner)),
///         mamori::configuration_set("slow", mamori::assign(monitor.limit_rad_s, 0.5)),
///         mamori::connect(encoder.joints, monitor.joints, mamori::fresh_within(2_ms)),
///         mamori::connect(monitor.joints, planner.joints, mamori::through(to_planner), mamori::any_age()),
///         mamori::faults<Fault::kOverspeed>(),
///         mamori::react(Fault::kOverspeed, Reaction::kSs1, mamori::within(20_ms)));
///     MAMORI_CHECK(kSystem);
///
/// Modes: mode_part.hpp.
///
/// @satisfies SWR-KRN-017, SWR-KRN-018, SWR-MOD-002      Design: docs/design/kernel.md#system-table
#ifndef MAMORI_KERNEL_SYSTEM_HPP
#define MAMORI_KERNEL_SYSTEM_HPP

#include <array>
#include <cstddef>
#include <cstdint>

#include "mamori/kernel/base/compiler_message.hpp"
#include "mamori/kernel/parameter/configuration_set.hpp"
#include "mamori/kernel/system/connection_part.hpp"
#include "mamori/kernel/system/detail/connection_builder.hpp"
#include "mamori/kernel/system/detail/option_words.hpp"
#include "mamori/kernel/system/detail/part_types.hpp"
#include "mamori/kernel/system/detail/system_builder.hpp"
#include "mamori/kernel/system/mode_part.hpp"
#include "mamori/kernel/system/reaction_part.hpp"
#include "mamori/kernel/system/system_part.hpp"
#include "mamori/kernel/system/system_rules.hpp"
#include "mamori/kernel/system/window_part.hpp"
#include "mamori/kernel/system/window_system.hpp"
#include "mamori/kernel/table/index_of.hpp"
#include "mamori/kernel/table/mode_builder.hpp"
#include "mamori/kernel/table/modelled_time_row.hpp"
#include "mamori/kernel/table/system_table.hpp"

namespace mamori {

namespace detail {

template <typename Builder, typename... Cs>
constexpr void add_part(Builder& builder, const WindowPart<Cs...>& part) noexcept {
    builder.add_window(part);
}
template <typename Builder, auto... kFaults>
constexpr void add_part(Builder& builder, const FaultsPart<kFaults...>&) noexcept {
    (builder.add(FaultRow{to_number(kFaults)}), ...);
}
template <typename Builder, std::size_t kModeCount>
constexpr void add_part(Builder& builder, const ConnectionPart<kModeCount>& part) noexcept {
    builder.add_connection(part);
}
template <typename Builder, typename Fault, typename Reaction>
constexpr void add_part(Builder& builder, const ReactionPart<Fault, Reaction>& part) noexcept {
    builder.add(part.row);
}
template <typename Builder>
constexpr void add_part(Builder& builder, const AbortPolicyPart& part) noexcept {
    builder.add(part.policy);
}
template <typename Builder, typename C>
constexpr void add_part(Builder& builder, const ModelledTimePart<C>& part) noexcept {
    builder.add(part.row);
}
template <typename Builder>
constexpr void add_part(Builder& builder, const PublicationMarginPart& part) noexcept {
    builder.table.publication_margin = part.margin;
}
template <typename Builder>
constexpr void add_part(Builder& builder, const ActionBudgetPart& part) noexcept {
    builder.table.action_budgets[0U] = part.budget;
}
template <typename Builder>
constexpr void add_part(Builder& builder, const TraceHashPart&) noexcept {
    builder.table.has_trace_hash = true;
}
template <typename Builder, std::size_t kAssignments, std::size_t kValues>
constexpr void add_part(Builder& builder, const ConfigurationSet<kAssignments, kValues>& set) noexcept {
    builder.configuration.add(set);
}
template <typename Builder, typename... Cs>
constexpr void add_part(Builder& builder, const SystemModePart<Cs...>& part) noexcept {
    builder.add_mode(part);
}
template <typename Builder, typename Event>
constexpr void add_part(Builder& builder, const ModeTransitionPart<Event>& part) noexcept {
    builder.add(part.row);
    builder.table.modes.event_enumeration = &kEnumerationTag<Event>;
}

template <typename Builder>
constexpr void add_part(Builder&, const PartGroup<>&) noexcept {}
template <typename Builder, typename First, typename... Rest>
constexpr void add_part(Builder& builder, const PartGroup<First, Rest...>& group) noexcept {
    add_part(builder, group.first);
    add_part(builder, group.rest);
}

template <typename Types>
using TableOf = SystemTable<
    Types::kWindows, Types::Components::kSize, Types::Ports::kSize, Types::kConnections, Types::Faults::kSize,
    Types::kReactions,
    ConfigurationTable<Types::Parameters::kSize, Types::kSets, Types::kAssignments, Types::kValues>,
    ModeTable<Types::kModes, Types::Members::kSize, Types::kModeTransitions, Types::kConnectionModes>>;

}  // namespace detail

/// A table with the types of its components and ports, so that compiler messages can name them.
template <typename PartTypes>
struct DescribedSystem : detail::TableOf<PartTypes> {
    using Types = PartTypes;
    /// Rows that no executive reads, so the view of the table does not have them.
    std::array<ModelledTimeRow, Types::ModelledComponents::kSize> modelled_times{};
    std::array<Duration, Types::kActionBudgets> action_budgets{};  ///< none, or the one that is stated
};

namespace detail {

/// @tparam Table DescribedSystem, or a table that a layer above derives from it; its parts then have an
///               add_part() for TableBuilder<Table>.
template <template <typename> class Table, typename... Parts>
constexpr auto build_system(Frame frame_part, const Parts&... parts) noexcept {
    using Types = JoinedTypes<Parts...>;
    static_assert(Types::kModes <= kSystemModeMax, "a system has at most 32 modes");
    using Modes = ModesOf<typename Types::ModeEnumerators>;
    static_assert(
        Types::ModeEnumerators::kSize == 0U || Types::ModeEnumerators::kSize == Types::kModes,
        "a mode without an enumerator; write system_mode<...>() and safe_mode<...>() for all modes");
    static_assert(Modes::kAreInOrder,
                  "the modes of a system are the enumerators 0, 1, ... of one enumeration, in this order");
    static_assert(kIsOfOneType<typename Types::Events>,
                  "the events of all transitions of a system are enumerators of one enumeration");
    static_assert(kIsOfOneType<typename Types::FaultTypes> && kIsOfOneType<typename Types::ReactionTypes>,
                  "all faults of a system are enumerators of one enumeration, and so are all reactions");
    static_assert(kTimesSaid<AbortPolicyPart, Parts...> <= 1U, "abort_policy(...) is said once");
    static_assert(kTimesSaid<PublicationMarginPart, Parts...> <= 1U,
                  "duplicate publication_margin(...); specify it at most once");
    static_assert(Types::kActionBudgets <= 1U, "duplicate action_budget(...); specify it at most once");
    static_assert(kTimesSaid<TraceHashPart, Parts...> <= 1U,
                  "duplicate trace_hash(); specify it at most once");
    TableBuilder<Table<Types>> builder{};
    builder.table.frame = frame_part.length;
    builder.table.modes.mode_enumeration = Modes::kTag;
    (add_part(builder, parts), ...);
    builder.table.configuration = builder.configuration.finish();
    resolve_background(builder.table);
    resolve_connections(builder.table);
    resolve_modes(builder.table);
    sort_connections(builder.table);
    return builder.table;
}

}  // namespace detail

/// Builds the table from a major frame and its parts, in any order. Windows, components, ports, connections,
/// modes and reactions are numbered in the order listed. MAMORI_CHECK reports violated rules. Everything that
/// the table refers to must outlive it. For constant expressions: O(rows squared).
template <typename... Parts>
constexpr auto system(Frame frame_part, const Parts&... parts) noexcept {
    return detail::build_system<DescribedSystem>(frame_part, parts...);
}

}  // namespace mamori

#endif  // MAMORI_KERNEL_SYSTEM_HPP
