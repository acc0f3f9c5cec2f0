// SPDX-License-Identifier: Apache-2.0
/// @file
/// Parts of a description that only mamori::safety::system(...) has: supervision of components, confirmation
/// of faults and stops, repeated self tests, protected connections, bounds of stops, brakes and watchdog.
///
/// @satisfies SWR-CYC-001, SWR-CYC-012, SWR-CYC-014, SWR-CYC-023, SWR-CYC-034
/// Design:   docs/design/safety_cycle.md#the-table
#ifndef MAMORI_SAFETY_SAFETY_PART_HPP
#define MAMORI_SAFETY_SAFETY_PART_HPP

#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "mamori/kernel/component/component.hpp"
#include "mamori/kernel/dataflow/data_port.hpp"
#include "mamori/kernel/system/connection_option.hpp"
#include "mamori/kernel/system/system_extension.hpp"
#include "mamori/safety/e2e/protected_receiver.hpp"
#include "mamori/safety/reaction/brake_sequence.hpp"
#include "mamori/safety/reaction/fault_register.hpp"
#include "mamori/safety/reaction/safe_state_machine.hpp"
#include "mamori/safety/self_test/self_test.hpp"
#include "mamori/safety/supervision/checkpoint_supervisor.hpp"
#include "mamori/safety/supervision/execution_supervisor.hpp"
#include "mamori/safety/supervision/watchdog_gate.hpp"

namespace mamori::safety {

/// Base of SafetyCycle, by which the check of a table finds its component.
class CycleComponent {
  protected:
    constexpr CycleComponent() noexcept = default;
    ~CycleComponent() = default;
};

/// Checkpoints of one component. Made by checkpoints().
struct Checkpoints {
    CheckpointSupervisor* supervisor{nullptr};  ///< nullptr: none
    const SupervisionTable* table{nullptr};     ///< of the supervisor
    EntityIndex entity{kNoEntity};
};
/// Supervision of one component.
struct SuperviseRow {
    WatchRow watch{};
    Checkpoints checkpoints{};
    FaultIndex fault{kNoFault};  ///< present while the component is expired; kNoFault: the watchdog expires
};
/// Confirmation and healing of one fault.
struct ConfirmRow {
    FaultIndex fault{kNoFault};
    Confirmation confirmation{};
    Healing healing{};
};
/// What shows that a stop has taken effect.
enum class StopConfirmation : std::uint8_t {
    kStandstill,    ///< CycleInputs::is_standing
    kClosedBrakes,  ///< CycleInputs::are_brakes_closed
    kTorqueOff,     ///< CycleInputs::has_torque is false
};
/// Number of the enumerators above.
inline constexpr std::size_t kStopConfirmationCount = 3U;
/// An output that delivers confirmations.
struct StopSourceRow {
    const OutPortBase* port{nullptr};
    std::array<bool, kStopConfirmationCount> confirms{};  ///< by the number of the confirmation
};
/// A self test that the safety cycle repeats, and the fault that it raises.
struct SelfTestRow {
    SelfTest* check{nullptr};
    Duration found_within{0};  ///< two passes end within it
    FaultIndex fault{kNoFault};
};
/// A protected connection, and the fault of its loss.
struct ProtectRow {
    const ProtectedReceiver* receiver{nullptr};
    const Component* component{nullptr};  ///< the receiver
    FreshWithin limit{};                  ///< of the message that was accepted last
    std::uint32_t max_delta{0U};          ///< largest accepted step of the counter; 0: no constant
    std::uint8_t profile{0U};             ///< number of the E2E profile
    FaultIndex fault{kNoFault};
};
/// Settings of the safety cycle that a table states once.
struct CycleRow {
    StopBounds stops{};
    BrakeLimits brakes{};
    WatchdogWindow watchdog{};
    Duration torque_feedback{0};           ///< longest time of torque despite STO, > 0
    Duration lateness_max{0};              ///< latest window start that is tolerated, >= 0
    FaultIndex late_fault{kNoFault};       ///< a reaction started later than its within(...)
    FaultIndex self_test_fault{kNoFault};  ///< a self test or an assumption failed
    FaultIndex brake_fault{kNoFault};      ///< the brakes did not confirm their closing in time
    std::uint64_t brakes_first{0U};        ///< faults whose STO waits for the brakes; bit n = fault n
};

namespace detail {

template <typename Fault>
constexpr FaultIndex to_fault(Fault fault) noexcept {
    static_assert(std::is_enum_v<Fault>, "faults are the enumerators of one enumeration");
    // A number out of range becomes one that the check rejects.
    const auto number = static_cast<std::uint64_t>(fault);
    return number < kNoFault ? static_cast<FaultIndex>(number) : static_cast<FaultIndex>(kNoFault - 1U);
}

}  // namespace detail

/// A component that does not run for this long is expired.
/// @param[in] late_cycles, expired_cycles safety cycles without a run; 1 <= late <= expired.
constexpr AliveLimits alive(std::uint32_t late_cycles = 2U, std::uint32_t expired_cycles = 3U) noexcept {
    return {late_cycles, expired_cycles};
}
/// Duration of each run of a component. @param[in] longest > 0. @param[in] shortest 0 .. longest.
constexpr DeadlineLimits deadline(Duration longest, Duration shortest = {}) noexcept {
    return {shortest, longest};
}

/// Checkpoints that a component reports (supervision_table.hpp). If they violate their table, the component
/// expires. The safety cycle steps the supervisor.
/// @tparam kTable         of the supervisor; one for all components of the system.
/// @param[in] supervisor  static storage. @param[in] entity of the table, reported by this component only.
template <const auto& kTable, typename Entity>
constexpr Checkpoints checkpoints(CheckpointSupervisor& supervisor, Entity entity) noexcept {
    static_assert(is_sound<kTable>());
    return {&supervisor, &kTable, detail::to_row_number(entity)};
}

/// Made by raises().
template <typename Fault>
struct Raises {
    Fault fault;
};
/// The fault that an expired component raises; a late one raises nothing. Without it, the watchdog is not
/// serviced while the component is late or expired.
template <typename Fault>
constexpr Raises<Fault> raises(Fault fault) noexcept {
    return {fault};
}

/// Kinds of parts.
struct SuperviseTag {};
struct ConfirmTag {};
struct StopSourceTag {};
struct SelfTestTag {};
struct ProtectTag {};
struct CycleTag {};

/// Made by supervise().
template <typename... Faults>
struct SupervisePart {
    using Types = extension::ExtensionTypes<SuperviseTag, Faults...>;
    SuperviseRow row{};
};
/// Supervises a component of the table. Its failure prevents the service of the watchdog.
/// @param[in] component run by a window; must outlive the table. @param[in] silence alive(...).
/// @param[in] duration deadline(...). @param[in] points checkpoints(...).
constexpr SupervisePart<> supervise(const Component& component, AliveLimits silence, DeadlineLimits duration,
                                    Checkpoints points = {}) noexcept {
    return {{watch(component, {silence, duration, SupervisionScope::kGlobal}), points, kNoFault}};
}
/// The same for a component whose failure is a declared fault. @param[in] fault raises(...).
template <typename Fault>
constexpr SupervisePart<Fault> supervise(const Component& component, AliveLimits silence,
                                         DeadlineLimits duration, Checkpoints points,
                                         Raises<Fault> fault) noexcept {
    return {{watch(component, {silence, duration, SupervisionScope::kLocal}), points,
             detail::to_fault(fault.fault)}};
}
template <typename Fault>
constexpr SupervisePart<Fault> supervise(const Component& component, AliveLimits silence,
                                         DeadlineLimits duration, Raises<Fault> fault) noexcept {
    return supervise(component, silence, duration, Checkpoints{}, fault);
}

/// Made by confirm().
template <typename Fault>
struct ConfirmPart {
    using Types = extension::ExtensionTypes<ConfirmTag, Fault>;
    ConfirmRow row{};
};
/// When a fault is latched, and when it may be acknowledged. Without it: in its first cycle, after one cycle
/// without it. @param[in] fault declared by faults<...>(). @param[in] confirmation, healing is_valid().
template <typename Fault>
constexpr ConfirmPart<Fault> confirm(Fault fault, Confirmation confirmation, Healing healing = {}) noexcept {
    return {{detail::to_fault(fault), confirmation, healing}};
}

/// Made by confirmed_by().
struct StopSourcePart {
    using Types = extension::ExtensionTypes<StopSourceTag>;
    StopSourceRow row{};
};
/// The source of one or more confirmations of stops. A confirmation counts only while the component of the
/// output is neither late nor expired.
/// @param[in] source        output of a supervised component that runs before the cycle, connected to it;
/// must
///                          outlive the table.
/// @param[in] confirmations enumerators of StopConfirmation; each has one source.
template <typename... Confirmations>
constexpr StopSourcePart confirmed_by(const OutPortBase& source, Confirmations... confirmations) noexcept {
    static_assert(sizeof...(Confirmations) > 0U && (std::is_same_v<Confirmations, StopConfirmation> && ...),
                  "confirmed_by(...) names an output and what it confirms");
    StopSourcePart part{{&source}};
    ((part.row.confirms[static_cast<std::size_t>(confirmations)] = true), ...);
    return part;
}

/// Made by found_within().
struct FoundWithin {
    Duration limit;
};
/// Longest time from the begin of a lasting fault to its detection by a self test: two passes of the test.
/// @param[in] limit at least two periods of the safety cycle.
constexpr FoundWithin found_within(Duration limit) noexcept {
    return {limit};
}

/// Made by self_test().
template <typename Fault>
struct SelfTestPart {
    using Types = extension::ExtensionTypes<SelfTestTag, Fault>;
    SelfTestRow row{};
};
/// The cycle repeats the check, with one step per cycle and from power-up on. The machine waits for the end
/// of the first pass. A failure is final: its fault is present until power is cycled.
/// @param[in] check must outlive the table. @param[in] time found_within(...). @param[in] fault raises(...).
template <typename Fault>
constexpr SelfTestPart<Fault> self_test(SelfTest& check, FoundWithin time, Raises<Fault> fault) noexcept {
    return {{&check, time.limit, detail::to_fault(fault.fault)}};
}
/// Without a time, a check has no steps: this does not compile.
template <typename Fault>
constexpr SelfTestPart<Fault> self_test(SelfTest&, Raises<Fault>) noexcept {
    static_assert(!std::is_enum_v<Fault>,
                  "a self_test(...) states found_within(...), the time for its steps");
    return {};
}

/// Made by protect().
template <typename Fault>
struct ProtectPart {
    using Types = extension::ExtensionTypes<ProtectTag, Fault>;
    ProtectRow row{};
};
/// A connection that end-to-end protection checks. While the last accepted message is older than the limit,
/// the machine does not start, and its fault is present while the machine is Operational or Degraded.
/// @param[in] receiver E2eReceiver or another ProtectedReceiver of messages with a member `sent_at_ns`; must
///                     outlive the table.
/// @param[in] limit    fresh_within(...). @param[in] fault raises(...).
template <typename Receiver, typename Fault>
constexpr ProtectPart<Fault> protect(const Receiver& receiver, FreshWithin limit,
                                     Raises<Fault> fault) noexcept {
    static_assert(detail::kHasSendTime<typename Receiver::Value>,
                  "a protected message states sent_at_ns, from which its age counts; use Stamped<...>");
    return {{&receiver, &receiver, limit, Receiver::kMaxDelta, Receiver::kProfile,
             detail::to_fault(fault.fault)}};
}
/// Without a fault, a loss has no reaction: this does not compile.
template <typename Receiver>
constexpr ProtectPart<void> protect(const Receiver&, FreshWithin) noexcept {
    static_assert(std::is_void_v<Receiver>, "a protect(...) states raises(...), the fault of a loss");
    return {};
}

/// Made by tolerated_lateness().
struct ToleratedLateness {
    Duration limit;
};
/// Latest window start that is tolerated. @param[in] limit >= 0.
constexpr ToleratedLateness tolerated_lateness(Duration limit) noexcept {
    return {limit};
}
/// Made by torque_feedback().
struct TorqueFeedback {
    Duration limit;
};
/// Torque that lasts longer than this after STO locks the machine out: only the watchdog can switch it off.
/// @param[in] limit > 0.
constexpr TorqueFeedback torque_feedback(Duration limit) noexcept {
    return {limit};
}
/// Made by the functions below. @tparam Tag what is wrong. @tparam Fault enumeration of the fault.
template <typename Tag, typename Fault>
struct OnFault {
    FaultIndex fault;
};
/// What is wrong.
struct LateReactionTag {};
struct FailedSelfTestTag {};
struct UnconfirmedBrakesTag {};

/// Fault of a reaction that starts later than its within(...). @param[in] fault raises(...).
template <typename Fault>
constexpr OnFault<LateReactionTag, Fault> on_late_reaction(Raises<Fault> fault) noexcept {
    return {detail::to_fault(fault.fault)};
}
/// Fault of a self test or an assumption that fails. @param[in] fault raises(...).
template <typename Fault>
constexpr OnFault<FailedSelfTestTag, Fault> on_failed_self_test(Raises<Fault> fault) noexcept {
    return {detail::to_fault(fault.fault)};
}
/// Fault of brakes whose contacts do not report "closed" within BrakeLimits::closes_within after the command;
/// never with brakes without contacts. @param[in] fault raises(...).
template <typename Fault>
constexpr OnFault<UnconfirmedBrakesTag, Fault> on_unconfirmed_brakes(Raises<Fault> fault) noexcept {
    return {detail::to_fault(fault.fault)};
}

/// Made by cycle(). @tparam Faults enumerations of its three faults.
template <typename... Faults>
struct CyclePart {
    using Types = extension::ExtensionTypes<CycleTag, Faults...>;
    CycleRow row{};
};

/// Made by brakes_first(). @tparam Fault enumeration of the faults.
template <typename Fault>
struct BrakesFirst {
    std::uint64_t faults;
};
/// Faults of a position that is not known, while the drives are trusted: their STO begins with the brakes
/// (SBC), and torque carries the machine until the brakes have closed, at most for
/// BrakeLimits::closes_within. It needs brakes with contacts and CycleInputs::can_hold. Another latched fault
/// with STO ends the torque at once.
/// @tparam kFault, kFaults declared faults of a table with at most 64 faults.
template <auto kFault, auto... kFaults>
constexpr BrakesFirst<decltype(kFault)> brakes_first() noexcept {
    static_assert((std::is_same_v<decltype(kFault), decltype(kFaults)> && ...),
                  "brakes_first<...>() names enumerators of one enumeration");
    static_assert(detail::to_fault(kFault) < 64U && ((detail::to_fault(kFaults) < 64U) && ...),
                  "brakes_first<...>() names faults 0 to 63");
    return {((std::uint64_t{1U} << detail::to_fault(kFault)) | ... |
             (std::uint64_t{1U} << detail::to_fault(kFaults)))};
}

namespace detail {

constexpr void apply(CycleRow& row, StopBounds option) noexcept {
    row.stops = option;
}
constexpr void apply(CycleRow& row, BrakeLimits option) noexcept {
    row.brakes = option;
}
constexpr void apply(CycleRow& row, WatchdogWindow option) noexcept {
    row.watchdog = option;
}
constexpr void apply(CycleRow& row, TorqueFeedback option) noexcept {
    row.torque_feedback = option.limit;
}
constexpr void apply(CycleRow& row, ToleratedLateness option) noexcept {
    row.lateness_max = option.limit;
}
template <typename Fault>
constexpr void apply(CycleRow& row, OnFault<LateReactionTag, Fault> option) noexcept {
    row.late_fault = option.fault;
}
template <typename Fault>
constexpr void apply(CycleRow& row, OnFault<FailedSelfTestTag, Fault> option) noexcept {
    row.self_test_fault = option.fault;
}
template <typename Fault>
constexpr void apply(CycleRow& row, OnFault<UnconfirmedBrakesTag, Fault> option) noexcept {
    row.brake_fault = option.fault;
}

template <typename Fault>
constexpr void apply(CycleRow& row, BrakesFirst<Fault> option) noexcept {
    row.brakes_first = option.faults;
}

/// Number of `Options` that are BrakesFirst, and enumeration of the first; that of the other faults without
/// it.
template <typename Other, typename... Options>
struct BrakesFirstOf {
    static constexpr std::size_t kCount = 0U;
    using Type = Other;
};
template <typename Other, typename Option, typename... Options>
struct BrakesFirstOf<Other, Option, Options...> : BrakesFirstOf<Other, Options...> {};
template <typename Other, typename Fault, typename... Options>
struct BrakesFirstOf<Other, BrakesFirst<Fault>, Options...> {
    static constexpr std::size_t kCount = 1U + BrakesFirstOf<Other, Options...>::kCount;
    using Type = Fault;
};

/// Number of `Options` that are OnFault of `Tag`, and enumeration of the first.
template <typename Tag, typename... Options>
struct OnFaultOf {
    static constexpr std::size_t kCount = 0U;
    using Type = void;
};
template <typename Tag, typename Option, typename... Options>
struct OnFaultOf<Tag, Option, Options...> : OnFaultOf<Tag, Options...> {};
template <typename Tag, typename Fault, typename... Options>
struct OnFaultOf<Tag, OnFault<Tag, Fault>, Options...> {
    static constexpr std::size_t kCount = 1U + OnFaultOf<Tag, Options...>::kCount;
    using Type = Fault;
};

}  // namespace detail

/// Settings of the safety cycle; once per table.
/// @param[in] options each once: StopBounds, BrakeLimits (they close within the bound of SS1),
///                    WatchdogWindow, torque_feedback(...), tolerated_lateness(...), on_late_reaction(...),
///                    on_failed_self_test(...), on_unconfirmed_brakes(...); optional:
///                    brakes_first<...>().
template <typename... Options>
constexpr auto cycle(const Options&... options) noexcept {
    static_assert(extension::kIsSaidOnce<StopBounds, Options...>, "a cycle states its StopBounds once");
    static_assert(extension::kIsSaidOnce<BrakeLimits, Options...>, "a cycle states its BrakeLimits once");
    static_assert(extension::kIsSaidOnce<WatchdogWindow, Options...>,
                  "a cycle states its WatchdogWindow once");
    static_assert(extension::kIsSaidOnce<TorqueFeedback, Options...>,
                  "a cycle states torque_feedback(...) once");
    static_assert(extension::kIsSaidOnce<ToleratedLateness, Options...>,
                  "a cycle states tolerated_lateness(...) once");
    static_assert(detail::OnFaultOf<LateReactionTag, Options...>::kCount == 1U,
                  "a cycle states on_late_reaction(...) once");
    static_assert(detail::OnFaultOf<FailedSelfTestTag, Options...>::kCount == 1U,
                  "a cycle states on_failed_self_test(...) once");
    static_assert(detail::OnFaultOf<UnconfirmedBrakesTag, Options...>::kCount == 1U,
                  "a cycle states on_unconfirmed_brakes(...) once");
    static_assert(detail::BrakesFirstOf<void, Options...>::kCount <= 1U,
                  "a cycle states brakes_first<...>() once");
    using LateFault = typename detail::OnFaultOf<LateReactionTag, Options...>::Type;
    CyclePart<LateFault, typename detail::BrakesFirstOf<LateFault, Options...>::Type,
              typename detail::OnFaultOf<FailedSelfTestTag, Options...>::Type,
              typename detail::OnFaultOf<UnconfirmedBrakesTag, Options...>::Type>
        part{};
    (detail::apply(part.row, options), ...);
    return part;
}

}  // namespace mamori::safety

#endif  // MAMORI_SAFETY_SAFETY_PART_HPP
