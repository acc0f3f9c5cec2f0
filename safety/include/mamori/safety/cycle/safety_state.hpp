// SPDX-License-Identifier: Apache-2.0
/// @file
/// What the safety cycle of a table remembers: supervision, faults, state, brakes and watchdog.
///
/// @satisfies SWR-CYC-003, SWR-CYC-013, SWR-CYC-014, SWR-CYC-036      Design:
/// docs/design/safety_cycle.md#memory
#ifndef MAMORI_SAFETY_SAFETY_STATE_HPP
#define MAMORI_SAFETY_SAFETY_STATE_HPP

#include <array>
#include <cstddef>
#include <utility>

#include "mamori/kernel/base/span.hpp"
#include "mamori/safety/assumptions/assumption_monitor.hpp"
#include "mamori/safety/cycle/decision_flow.hpp"
#include "mamori/safety/cycle/safety_part.hpp"
#include "mamori/safety/cycle/safety_rules.hpp"
#include "mamori/safety/redundancy/complement_stored.hpp"
#include "mamori/safety/self_test/schedule.hpp"

namespace mamori::safety {

namespace detail {

/// Components that deliver the confirmations, by the number of the confirmation; kNoIndex: none.
template <typename Table>
constexpr std::array<std::size_t, kStopConfirmationCount> find_stop_sources(const Table& table) noexcept {
    std::array<std::size_t, kStopConfirmationCount> sources{kNoIndex, kNoIndex, kNoIndex};
    for (std::size_t c = 0U; c < kStopConfirmationCount; ++c) {
        for (std::size_t i = 0U; i < table.stop_sources.size(); ++i) {
            if (table.stop_sources[i].confirms[c]) {
                sources[c] = find_owner(table, table.stop_sources[i].port);
            }
        }
    }
    return sources;
}

/// The supervisor of all checkpoints; nullptr: none.
template <typename Table>
constexpr CheckpointSupervisor* find_checkpoints(const Table& table) noexcept {
    for (std::size_t i = 0U; i < table.supervised.size(); ++i) {
        if (table.supervised[i].checkpoints.supervisor != nullptr) {
            return table.supervised[i].checkpoints.supervisor;
        }
    }
    return nullptr;
}

/// A schedule for each check: each keeps its own time and continues when another has failed.
template <std::size_t kCount, std::size_t... kIndices>
constexpr std::array<SelfTestSchedule, kCount> make_schedules(
    [[maybe_unused]] const std::array<SelfTestRow, kCount>& rows,
    std::index_sequence<kIndices...> /*indices*/) noexcept {
    return {{SelfTestSchedule{{&rows[kIndices].check, 1U}, Duration{rows[kIndices].found_within.ns / 2}}...}};
}

/// A monitor of the assumptions; none without assumptions.
template <std::size_t... kIndices>
constexpr std::array<AssumptionMonitor, sizeof...(kIndices)> make_monitors(
    [[maybe_unused]] Span<const AssumptionRow> rows, std::index_sequence<kIndices...> /*monitors*/) noexcept {
    return {{(static_cast<void>(kIndices), AssumptionMonitor{rows})...}};
}

}  // namespace detail

/// Memory for the table `kTable` of safety::system(), in static storage.
template <const auto& kTable>
struct SafetyStorage {
    static_assert(keeps_safety_rules<kTable>());
    ExecutionStorageFor<kTable> execution{};
    std::array<FaultRecord, kTable.faults.size()> faults{};
    static constexpr std::size_t kMonitors = kTable.assumptions.empty() ? 0U : 1U;
    std::array<AssumptionMonitor, kMonitors> assumptions{
        detail::make_monitors(kTable.assumptions, std::make_index_sequence<kMonitors>{})};
    std::array<SelfTestSchedule, kTable.self_tests.size()> self_tests{
        detail::make_schedules(kTable.self_tests, std::make_index_sequence<kTable.self_tests.size()>{})};
};

/// All state of one safety cycle. A component of the table can refer to one that is declared before the table
/// and defined after it:
///
///     extern mamori::safety::SafetyState safety;
///     static Supervisor supervisor{safety};                    // derived from SafetyCycle
///     static constexpr auto kSystem = mamori::safety::system(..., mamori::run(supervisor), ...);
///     static mamori::safety::SafetyStorage<kSystem> storage;
///     mamori::safety::SafetyState safety{storage, watchdog};
///
/// Thread safety: get_observer() as ExecutionSupervisor; all other members from the context of the cycle.
/// Memory:        no heap; all state is here and in the storage, which must outlive this object.
class SafetyState final {
  public:
    /// @param[in] storage of the table. @param[in] watchdog must outlive this object.
    template <const auto& kTable>
    constexpr SafetyState(SafetyStorage<kTable>& storage, Watchdog& watchdog) noexcept
        : table_(make_safety_view(kTable)),
          assumptions_(storage.assumptions),
          reactions_(kTable.reactions),
          stop_sources_(detail::find_stop_sources(kTable)),
          checkpoints_(detail::find_checkpoints(kTable)),
          schedules_(storage.self_tests),
          period_(kTable.windows[detail::kCycleWindow<kTable>].period),
          faults_(storage.faults),
          machine_(kTable.cycle.stops),
          brakes_(kTable.cycle.brakes),
          gate_(watchdog, kTable.cycle.watchdog),
          supervision_(storage.execution, kTable.cycle.lateness_max) {}
    SafetyState(const SafetyState&) = delete;
    SafetyState& operator=(const SafetyState&) = delete;

    /// Rows of the safety layer, for example for mamori::table_dump.
    const SafetyView& get_table() const noexcept { return table_; }
    /// Supervision of the components: observer of the executive.
    ExecutionSupervisor& get_observer() noexcept { return supervision_; }
    const ExecutionSupervisor& get_supervision() const noexcept { return supervision_; }
    const FaultRegister& get_faults() const noexcept { return faults_; }
    SafeState get_state() const noexcept { return machine_.get_state(); }
    /// Schedules of the self tests of the table, in its order.
    Span<const SelfTestSchedule> get_self_tests() const noexcept {
        return {schedules_.data(), schedules_.size()};
    }
    /// Supervision of the cycle itself.
    DecisionFlow& get_flow() noexcept { return flow_; }

  private:
    friend class SafetyCycle;

    DecisionFlow flow_{};
    SafetyView table_;
    Span<AssumptionMonitor> assumptions_;
    Span<const ReactionRow> reactions_;
    std::array<std::size_t, kStopConfirmationCount> stop_sources_;
    CheckpointSupervisor* checkpoints_;
    Span<SelfTestSchedule> schedules_;
    Duration period_;  ///< of the safety cycle
    /// With its complement: it decides when the watchdog has to switch off what the software cannot.
    ComplementStored<Duration> torque_despite_sto_for_{Duration{0}};
    FaultRegister faults_;
    SafeStateMachine machine_;
    BrakeSequence brakes_;
    WatchdogGate gate_;
    ExecutionSupervisor supervision_;
};

}  // namespace mamori::safety

#endif  // MAMORI_SAFETY_SAFETY_STATE_HPP
