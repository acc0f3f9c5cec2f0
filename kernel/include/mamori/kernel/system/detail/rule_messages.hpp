// SPDX-License-Identifier: Apache-2.0
/// @file
/// The rules of a system table as compiler messages. Each rule is a template that no table may instantiate:
/// the compiler shows it with its arguments, the faulty element, and the sentence of the rule. Not for users.
///
/// @satisfies SWR-KRN-018, SWR-MOD-003      Design: docs/design/kernel.md#system-table
#ifndef MAMORI_KERNEL_RULE_MESSAGES_HPP
#define MAMORI_KERNEL_RULE_MESSAGES_HPP

#include <cstddef>

#include "mamori/kernel/base/compiler_message.hpp"
#include "mamori/kernel/base/type_list.hpp"
#include "mamori/kernel/parameter/configuration_check.hpp"
#include "mamori/kernel/parameter/configuration_table.hpp"
#include "mamori/kernel/system/detail/component_constant.hpp"
#include "mamori/kernel/system/detail/spelled_name.hpp"
#include "mamori/kernel/system/detail/table_element.hpp"
#include "mamori/kernel/table/action_budget.hpp"
#include "mamori/kernel/table/modelled_time_row.hpp"
#include "mamori/kernel/table/system_check.hpp"
#include "mamori/kernel/table/system_finding.hpp"
#include "mamori/kernel/table/table_rules.hpp"

namespace mamori {

namespace rules {

// Template parameters of a rule, for each kind of faulty element. The last one of a component or port
// distinguishes instances of one type: 0 is the first in the table.
#define MAMORI_PARAMETERS_OF_Row typename...
#define MAMORI_PARAMETERS_OF_Ends typename...
#define MAMORI_PARAMETERS_OF_Window typename...
#define MAMORI_PARAMETERS_OF_TwoWindows typename...
#define MAMORI_PARAMETERS_OF_Component typename, std::size_t
#define MAMORI_PARAMETERS_OF_Input typename, auto, std::size_t
#define MAMORI_PARAMETERS_OF_Sink typename, auto, std::size_t
#define MAMORI_PARAMETERS_OF_UnlistedPort typename...
#define MAMORI_PARAMETERS_OF_UnlistedParameter typename...
#define MAMORI_PARAMETERS_OF_Parameter typename, auto, std::size_t
#define MAMORI_PARAMETERS_OF_Port typename, auto, std::size_t
#define MAMORI_PARAMETERS_OF_ModelledTime typename...
#define MAMORI_PARAMETERS_OF_Fault auto
#define MAMORI_PARAMETERS_OF_FaultInMode auto, typename...
#define MAMORI_PARAMETERS_OF_Mode typename...
#define MAMORI_PARAMETERS_OF_ModeMember typename...
#define MAMORI_PARAMETERS_OF_ModeSet typename...
#define MAMORI_PARAMETERS_OF_InputInMode typename...
#define MAMORI_PARAMETERS_OF_ConnectionMode typename...
#define MAMORI_PARAMETERS_OF_Transition typename...
#define MAMORI_PARAMETERS_OF_TransitionEvent typename, std::size_t
#define MAMORI_PARAMETERS_OF_TransitionTarget typename...
#define MAMORI_PARAMETERS_OF_ComponentInMode typename...
#define MAMORI_PARAMETERS_OF_SetAssignment typename...

#define MAMORI_RULE(name, Message, Faulty, sentence) \
    template <MAMORI_PARAMETERS_OF_##Faulty>         \
    struct Message {                                 \
        static_assert(kKept<Message>, sentence);     \
    };
MAMORI_TABLE_RULES(MAMORI_RULE)
#undef MAMORI_RULE

}  // namespace rules

namespace detail {

template <template <typename...> class R, const auto& kTable, MemberKind kKind, std::size_t kComponent,
          std::size_t kLater>
using OfUnlisted = R<ComponentAt<kTable, kComponent>,
                     NameOf<kTable, OfUnlistedMember<ComponentAt<kTable, kComponent>, kKind>, kLater>>;

/// A rule with the faulty element as its arguments.
namespace faulty {

template <template <typename...> class R, const auto& kTable, std::size_t kElement, std::size_t>
using Row = R<rules::Row<kElement>>;
template <template <typename...> class R, const auto& kTable, std::size_t kElement, std::size_t>
using Ends = R<decltype(show_end<kTable, find_output(kTable, kTable.connections[kElement].source)>()),
               decltype(show_end<kTable, find_input(kTable, kTable.connections[kElement].sink)>()),
               rules::Row<kElement>>;
template <template <typename...> class R, const auto& kTable, std::size_t kElement, std::size_t>
using Window = R<WindowName<kTable, kElement>>;
template <template <typename...> class R, const auto& kTable, std::size_t kElement, std::size_t kOther>
using TwoWindows = R<WindowName<kTable, kOther>, WindowName<kTable, kElement>>;
template <template <typename, std::size_t> class R, const auto& kTable, std::size_t kElement, std::size_t>
using Component = R<ComponentAt<kTable, kElement>, calc_instance<kTable, kElement>()>;
template <template <typename, auto, std::size_t> class R, const auto& kTable, std::size_t kElement,
          std::size_t>
using Input = OfPort<R, kTable, kElement>;
template <template <typename, auto, std::size_t> class R, const auto& kTable, std::size_t kElement,
          std::size_t>
using Sink = OfSink<R, kTable, kElement>;
template <template <typename...> class R, const auto& kTable, std::size_t kElement, std::size_t kOther>
using UnlistedPort = OfUnlisted<R, kTable, MemberKind::kPort, kElement, kOther>;
template <template <typename...> class R, const auto& kTable, std::size_t kElement, std::size_t kOther>
using UnlistedParameter = OfUnlisted<R, kTable, MemberKind::kParameter, kElement, kOther>;
template <template <typename, auto, std::size_t> class R, const auto& kTable, std::size_t kElement,
          std::size_t>
using Parameter = OfParameter<R, kTable, kElement>;
template <template <typename, auto, std::size_t> class R, const auto& kTable, std::size_t kElement,
          std::size_t>
using Port = OfPort<R, kTable, kElement>;
template <template <typename...> class R, const auto& kTable, std::size_t kElement, std::size_t>
using ModelledTime = R<At<typename TypesOf<kTable>::ModelledComponents, kElement>, rules::Row<kElement>>;
template <template <auto> class R, const auto& kTable, std::size_t kElement, std::size_t>
using Fault = R<At<typename TypesOf<kTable>::Faults, kElement>::kValue>;
/// Without the mode in a table without modes.
template <template <auto, typename...> class R, const auto& kTable, std::size_t kElement, std::size_t kOther,
          bool kHasModes>
struct ShowFaultInMode {
    using Type = R<At<typename TypesOf<kTable>::Faults, kElement>::kValue>;
};
template <template <auto, typename...> class R, const auto& kTable, std::size_t kElement, std::size_t kOther>
struct ShowFaultInMode<R, kTable, kElement, kOther, true> {
    using Type = R<At<typename TypesOf<kTable>::Faults, kElement>::kValue, ModeName<kTable, kOther>>;
};
template <template <auto, typename...> class R, const auto& kTable, std::size_t kElement, std::size_t kOther>
using FaultInMode =
    typename ShowFaultInMode<R, kTable, kElement, kOther, TypesOf<kTable>::kModes != 0U>::Type;
template <template <typename...> class R, const auto& kTable, std::size_t kElement, std::size_t>
using Mode = R<ModeName<kTable, kElement>>;
template <template <typename...> class R, const auto& kTable, std::size_t kElement, std::size_t>
using ModeMember =
    R<ModeName<kTable, kTable.modes.members[kElement].mode>, At<typename TypesOf<kTable>::Members, kElement>>;
template <template <typename...> class R, const auto& kTable, std::size_t kElement, std::size_t>
using ModeSet = R<ModeName<kTable, kElement>, NameOf<kTable, OfSetOfMode, kElement>>;
template <template <typename...> class R, const auto& kTable, std::size_t kElement, std::size_t kOther>
using InputInMode = R<ModeName<kTable, kOther>, PortAt<kTable, kElement>>;
template <template <typename...> class R, const auto& kTable, std::size_t kElement, std::size_t>
using ConnectionMode = R<NameOf<kTable, OfConnectionMode, kElement>>;
template <template <typename...> class R, const auto& kTable, std::size_t kElement, std::size_t>
using Transition = R<NameOf<kTable, OfSource, kElement>, NameOf<kTable, OfTarget, kElement>>;
template <template <typename, std::size_t> class R, const auto& kTable, std::size_t kElement, std::size_t>
using TransitionEvent = R<NameOf<kTable, OfSource, kElement>, kTable.modes.transitions[kElement].event>;
template <template <typename...> class R, const auto& kTable, std::size_t kElement, std::size_t>
using TransitionTarget = R<NameOf<kTable, OfTarget, kElement>>;
template <template <typename...> class R, const auto& kTable, std::size_t kElement, std::size_t kOther>
using ComponentInMode = R<ComponentAt<kTable, kElement>, ModeName<kTable, kOther>>;
/// Shows the violated rule of the configuration, its set and parameter.
template <template <typename...> class, const auto& kTable, std::size_t kElement, std::size_t kOther>
using SetAssignment =
    ConfigurationMessage<check(make_view(kTable.configuration)).rule, NameOf<kTable, OfSet, kElement>,
                         typename TypesOf<kTable>::Parameters, kElement, kOther,
                         find_assigned(make_view(kTable.configuration), kElement, kOther)>;

}  // namespace faulty

template <Rule kRule>
struct MessageOf;
#define MAMORI_MESSAGE(name, Message, Faulty, sentence)                         \
    template <>                                                                 \
    struct MessageOf<Rule::k##name> {                                           \
        template <const auto& kTable, std::size_t kElement, std::size_t kOther> \
        using Type = faulty::Faulty<rules::Message, kTable, kElement, kOther>;  \
    };
MAMORI_TABLE_RULES(MAMORI_MESSAGE)
#undef MAMORI_MESSAGE

/// Evaluating the size of the message of a violated rule stops the compilation.
template <const auto& kTable>
constexpr bool keeps_rules() noexcept {
    // Members first: a port that is listed twice also causes inconsistent rows.
    constexpr Finding kOfMembers = find_faulty_member(typename TypesOf<kTable>::Components{});
    constexpr Finding kOfRows = kOfMembers.rule != Rule::kNone ? kOfMembers : check(make_view(kTable));
    constexpr Finding kOfTimes = kOfRows.rule != Rule::kNone
                                     ? kOfRows
                                     : check_modelled_times(kTable.modelled_times, kTable.components);
    constexpr Finding kFinding =
        kOfTimes.rule != Rule::kNone ? kOfTimes : check_action_budget(kTable.action_budgets);
    if constexpr (kFinding.rule != Rule::kNone) {
        return sizeof(typename MessageOf<kFinding.rule>::template Type<kTable, kFinding.element,
                                                                       kFinding.other>) == 0U;
    }
    return true;
}

}  // namespace detail

}  // namespace mamori

#endif  // MAMORI_KERNEL_RULE_MESSAGES_HPP
