// SPDX-License-Identifier: Apache-2.0
/// @file
/// The words of a system description: cores with windows, components, connections, faults and reactions, in
/// one constant of the program that MAMORI_CHECK makes the compiler prove.
///
///     static constexpr auto kSystem = mamori::system(
///         mamori::frame(10_ms),
///         mamori::window("sense", 0_us, 200_us, mamori::every(1_ms), mamori::rate(1000_hz),
///                        mamori::budget(150_us), mamori::run(encoder, mamori::worst_case(monitor, 40_us))),
///         mamori::window("plan", 1200_us, 8_ms, mamori::core(1), mamori::budget(7_ms),
///                        mamori::run(planner)),
///         mamori::configuration_set("slow", mamori::assign(monitor.limit_rad_s, 0.5)),
///         mamori::connect(encoder.joints, monitor.joints, mamori::fresh_within(2_ms)),
///         mamori::connect(monitor.joints, planner.joints, mamori::through(to_planner)),
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
#include <type_traits>

#include "mamori/kernel/configuration_set.hpp"
#include "mamori/kernel/mode_builder.hpp"
#include "mamori/kernel/mode_part.hpp"
#include "mamori/kernel/system_builder.hpp"
#include "mamori/kernel/system_rules.hpp"
#include "mamori/kernel/window_part.hpp"

namespace mamori {

/// Length of the major frame, after which everything repeats; the same for all cores.
struct Frame {
    Duration length;
};
/// @param[in] length > 0.
constexpr Frame frame(Duration length) noexcept {
    return {length};
}

struct FreshWithin {
    Duration age_max;
};
/// Age at which the value of an input is stale: its status becomes kBufferTimeout. @param[in] age_max > 0.
constexpr FreshWithin fresh_within(Duration age_max) noexcept {
    return {age_max};
}

template <typename T>
struct Through {
    Crossing<T>& crossing;
};
/// Storage of a connection that leaves its core or partition; static, used by one connection.
template <typename T>
constexpr Through<T> through(Crossing<T>& crossing) noexcept {
    return {crossing};
}

/// @tparam kModeCount modes that its only_in() names.
template <std::size_t kModeCount>
struct ConnectionPart {
    struct Types : detail::NoTypes {
        static constexpr std::size_t kConnections = 1U;
        static constexpr std::size_t kConnectionModes = kModeCount;
    };
    ConnectionRow row{};
    std::array<const char*, kModeCount> modes{};
};

namespace detail {

template <typename Option>
inline constexpr std::size_t kModesNamedBy = 0U;
template <std::size_t kCount>
inline constexpr std::size_t kModesNamedBy<OnlyIn<kCount>> = kCount;

template <typename T, typename Sink, typename Part>
constexpr void apply(Part& part, FreshWithin option) noexcept {
    part.row.age_max = option.age_max;
}
template <typename T, typename Sink, typename Part, std::size_t kCount>
constexpr void apply(Part& part, const OnlyIn<kCount>& option) noexcept {
    part.modes = option.modes;
}
template <typename T, typename Sink, typename Part, typename U>
constexpr void apply(Part& part, Through<U> option) noexcept {
    static_assert(std::is_same_v<T, U>, "the Crossing of a connection carries its payload type");
    static_assert(!Sink::kIsQueue, "a queue is its own buffer; connect it without through(...)");
    part.row.crossing = &option.crossing;
    part.row.operations = CrossingConnection<T, Sink>::kOperations;
}

}  // namespace detail

/// Feeds `sink` from `source`; their payload types must be the same.
/// @param[in] sink    InPort or QueueInPort. @param[in] options fresh_within(...), through(...),
/// only_in(...).
template <typename T, typename Sink, typename... Options>
constexpr ConnectionPart<(detail::kModesNamedBy<Options> + ... + 0U)> connect(OutPort<T>& source, Sink& sink,
                                                                              Options... options) noexcept {
    static_assert(std::is_base_of_v<InPortBase, Sink>, "connect() joins an output to an input");
    static_assert(std::is_same_v<T, typename Sink::Payload>, "connect() joins ports of one payload type");
    ConnectionPart<(detail::kModesNamedBy<Options> + ... + 0U)> part{};
    part.row.source = &source;
    part.row.sink = &sink;
    if constexpr (std::is_same_v<T, typename Sink::Payload>) {
        using Connection = std::conditional_t<Sink::kIsQueue, detail::QueueConnection<T, Sink>,
                                              detail::LatestConnection<T, Sink>>;
        part.row.operations = Connection::kOperations;
        (detail::apply<T, Sink>(part, options), ...);
    }
    return part;
}

/// A fault as a compiler message shows it.
template <auto kFault>
struct FaultName {
    static constexpr auto kValue = kFault;
};
template <auto... kFaults>
struct FaultsPart {
    struct Types : detail::NoTypes {
        using Faults = detail::TypeList<FaultName<kFaults>...>;
    };
};
/// Declares faults, each an enumerator of the application: the table is refused until each has one reaction.
template <auto... kFaults>
constexpr FaultsPart<kFaults...> faults() noexcept {
    static_assert((std::is_enum_v<decltype(kFaults)> && ...),
                  "faults are the enumerators of one enumeration");
    return {};
}

struct Within {
    Duration limit;
};
/// Time from the confirmed fault to the start of its reaction. @param[in] limit > 0.
constexpr Within within(Duration limit) noexcept {
    return {limit};
}

struct ReactionPart {
    struct Types : detail::NoTypes {
        static constexpr std::size_t kReactions = 1U;
    };
    ReactionRow row{};
};
/// What a fault leads to; both are enumerators of the application or of the safety layer.
template <typename Fault, typename Reaction>
constexpr ReactionPart react(Fault fault, Reaction reaction, Within time) noexcept {
    static_assert(std::is_enum_v<Fault> && std::is_enum_v<Reaction>,
                  "a fault and a reaction are enumerators");
    return {{static_cast<std::uint32_t>(fault), static_cast<std::uint32_t>(reaction), time.limit}};
}

struct AbortPolicyPart {
    using Types = detail::NoTypes;
    AbortPolicy policy;
};
/// Which actions a component gets on its way to Error, in the whole system; without it kSpecOnly.
constexpr AbortPolicyPart abort_policy(AbortPolicy policy) noexcept {
    return {policy};
}

namespace detail {

template <typename Builder, typename... Cs>
constexpr void add_part(Builder& builder, const WindowPart<Cs...>& part) noexcept {
    builder.add_window(part);
}
template <typename Builder, auto... kFaults>
constexpr void add_part(Builder& builder, const FaultsPart<kFaults...>&) noexcept {
    (builder.add(FaultRow{static_cast<std::uint32_t>(kFaults)}), ...);
}
template <typename Builder, std::size_t kModeCount>
constexpr void add_part(Builder& builder, const ConnectionPart<kModeCount>& part) noexcept {
    builder.add_connection(part);
}
template <typename Builder>
constexpr void add_part(Builder& builder, const ReactionPart& part) noexcept {
    builder.add(part.row);
}
template <typename Builder>
constexpr void add_part(Builder& builder, const AbortPolicyPart& part) noexcept {
    builder.add(part.policy);
}
template <typename Builder, std::size_t kAssignments, std::size_t kValues>
constexpr void add_part(Builder& builder, const ConfigurationSet<kAssignments, kValues>& set) noexcept {
    builder.configuration.add(set);
}
template <typename Builder, typename... Cs>
constexpr void add_part(Builder& builder, const SystemModePart<Cs...>& part) noexcept {
    builder.add_mode(part);
}
template <typename Builder>
constexpr void add_part(Builder& builder, const ModeTransitionPart& part) noexcept {
    builder.add(part.row);
}

template <typename Types>
using TableOf = SystemTable<
    Types::kWindows, Types::Components::kSize, Types::Ports::kSize, Types::kConnections, Types::Faults::kSize,
    Types::kReactions,
    ConfigurationTable<Types::kParameters, Types::kSets, Types::kAssignments, Types::kValues>,
    ModeTable<Types::kModes, Types::Members::kSize, Types::kModeTransitions, Types::kConnectionModes>>;

}  // namespace detail

/// A table that still knows the types of its components and ports, so that the compiler can name them.
template <typename PartTypes>
struct DescribedSystem : detail::TableOf<PartTypes> {
    using Types = PartTypes;
};

/// Builds the table from a frame and its parts, in any order; components are numbered as they are listed.
template <typename... Parts>
constexpr auto system(Frame frame_part, const Parts&... parts) noexcept {
    using Types = detail::JoinedTypes<Parts...>;
    static_assert(Types::kModes <= kSystemModeMax, "a system has at most 32 modes");
    detail::TableBuilder<DescribedSystem<Types>> builder{};
    builder.table.frame = frame_part.length;
    (detail::add_part(builder, parts), ...);
    builder.table.configuration = builder.configuration.finish();
    detail::resolve_connections(builder.table);
    detail::resolve_modes(builder.table);
    detail::sort_connections(builder.table);
    return builder.table;
}

}  // namespace mamori

#endif  // MAMORI_KERNEL_SYSTEM_HPP
