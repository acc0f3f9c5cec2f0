// SPDX-License-Identifier: Apache-2.0
/// @file
/// Functions faults(...) and react(...): the faults that a system declares, and the reaction to each.
///
/// @satisfies SWR-KRN-017      Design: docs/design/kernel.md#system-table
#ifndef MAMORI_KERNEL_REACTION_PART_HPP
#define MAMORI_KERNEL_REACTION_PART_HPP

#include <cstddef>
#include <type_traits>

#include "mamori/kernel/base/enumerator.hpp"
#include "mamori/kernel/base/time.hpp"
#include "mamori/kernel/base/type_list.hpp"
#include "mamori/kernel/system/detail/part_types.hpp"
#include "mamori/kernel/table/mode_mask.hpp"
#include "mamori/kernel/table/system_table.hpp"

namespace mamori {

/// A fault as a compiler message shows it.
template <auto kFault>
struct FaultName {
    static constexpr auto kValue = kFault;
};
/// Made by faults().
template <auto... kFaults>
struct FaultsPart {
    struct Types : detail::NoTypes {
        using Faults = detail::TypeList<FaultName<kFaults>...>;
        using FaultTypes = detail::TypeList<decltype(kFaults)...>;
    };
};
/// Declares faults, each an enumerator of the application or of the safety layer. Each is declared once. The
/// table is rejected unless each fault has one reaction.
template <auto... kFaults>
constexpr FaultsPart<kFaults...> faults() noexcept {
    static_assert((std::is_enum_v<decltype(kFaults)> && ...),
                  "faults are the enumerators of one enumeration");
    return {};
}

/// Made by within().
struct Within {
    Duration limit;
};
/// Time from the confirmed fault to the start of its reaction. @param[in] limit > 0.
constexpr Within within(Duration limit) noexcept {
    return {limit};
}

/// Made by in_modes().
struct InModes {
    ModeMask mask;
};
/// Modes in which a reaction is the answer to its fault; without it, every mode.
/// @tparam kModes enumerators of the modes of the table, each below kSystemModeMax.
template <auto... kModes>
constexpr InModes in_modes() noexcept {
    static_assert(sizeof...(kModes) > 0U && ((detail::to_number(kModes) < kSystemModeMax) && ...),
                  "in_modes<...>() names modes of the table");
    return {(to_mask(detail::to_number(kModes)) | ...)};
}

/// Made by react().
template <typename Fault, typename Reaction>
struct ReactionPart {
    struct Types : detail::NoTypes {
        using FaultTypes = detail::TypeList<Fault>;
        using ReactionTypes = detail::TypeList<Reaction>;
        static constexpr std::size_t kReactions = 1U;
    };
    ReactionRow row{};
};
/// Reaction to a fault; both are enumerators of the application or of the safety layer, at most 32 bits. The
/// kernel checks and stores the row, and the safety layer executes it. Each fault has exactly one reaction in
/// each mode of the table.
template <typename Fault, typename Reaction>
constexpr ReactionPart<Fault, Reaction> react(Fault fault, Reaction reaction, Within time,
                                              InModes modes = {kEveryMode}) noexcept {
    return {{detail::to_number(fault), detail::to_number(reaction), time.limit, modes.mask}};
}

}  // namespace mamori

#endif  // MAMORI_KERNEL_REACTION_PART_HPP
