// SPDX-License-Identifier: Apache-2.0
/// @file
/// Supervision of the components of one executive: reads what it records of its course, judges each component
/// once per supervision cycle (alive, deadline, budget) and sums the judgements up to the status of the
/// whole.
///
/// @satisfies SWR-SUP-007, SWR-SUP-008, SWR-SUP-009, SWR-SUP-010, SWR-SUP-040, SWR-CYC-014
/// Design:   docs/design/supervision.md#local-and-global-status
/// Source:   IEC 61508-2:2010 Table A.10 (monitoring of program sequence)
#ifndef MAMORI_SAFETY_EXECUTION_SUPERVISOR_HPP
#define MAMORI_SAFETY_EXECUTION_SUPERVISOR_HPP

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "mamori/kernel/component/component.hpp"
#include "mamori/kernel/run/execution_observer.hpp"
#include "mamori/kernel/table/index_of.hpp"
#include "mamori/kernel/table/mode_table.hpp"
#include "mamori/safety/supervision/alive_supervisor.hpp"
#include "mamori/safety/supervision/deadline_limits.hpp"

namespace mamori::safety {

/// Health of one component; ordered, the worst is the largest.
enum class LocalStatus : std::uint8_t {
    kOk,
    kFailed,   ///< late, may recover by itself
    kExpired,  ///< latched until acknowledge()
};

/// Health of all components of global scope; ordered, the worst is the largest.
enum class GlobalStatus : std::uint8_t { kOk, kFailed, kExpired };

/// What the failure of a component means for the watchdog.
enum class SupervisionScope : std::uint8_t {
    kGlobal,  ///< takes part in the global status: the watchdog is not serviced without it
    kLocal,   ///< has a local status only, for which the application declares a fault and its reaction
};

/// Why a component expired.
enum class ExpiryCause : std::uint8_t {
    kNone,
    kBudgetOverrun,  ///< it was aborted, or returned after the budget of its window
    kDeadline,       ///< a run was shorter or longer than its limits
    kSilent,         ///< it does not run
    kInError,        ///< it does not run, because its state is Error
    kOutOfOrder,     ///< its checkpoints came in a wrong order or number
};
/// Spelling of a cause in logs, indexed by its number.
inline constexpr std::array<const char*, 6U> kExpiryCauseNames{"none",   "budget_overrun", "deadline",
                                                               "silent", "in_error",       "out_of_order"};

/// Limits of one component.
struct ComponentLimits {
    AliveLimits alive{};
    DeadlineLimits deadline{};
    SupervisionScope scope{SupervisionScope::kGlobal};
};

/// Limits of one component of the system table. Made by watch().
struct WatchRow {
    const Component* component{nullptr};
    ComponentLimits limits{};
};
/// Row of a list of limits.
/// @param[in] component of the system table; must outlive the list. @param[in] limits valid.
constexpr WatchRow watch(const Component& component, const ComponentLimits& limits) noexcept {
    return {&component, limits};
}

/// Storage of one component. Written by ExecutionSupervisor only.
struct ComponentSlot {
    std::atomic<bool> is_overrun_pending{false};  ///< set from a guard's context
    bool is_global{true};                         ///< scope
    bool is_conspicuous{true};                    ///< to be weighed, even after runs within their limits
    LocalStatus status{LocalStatus::kOk};
    ExpiryCause cause{ExpiryCause::kNone};
    bool has_just_expired{false};  ///< in the last step
    Instant expired_at{};
};

/// Storage for the components 0 .. kComponentCount - 1 of the system table.
template <std::size_t kComponentCount>
struct ExecutionStorage {
    using Slots = ExecutionStorage;
    std::array<ExecutionRecord, kComponentCount> records{};  ///< written by the executive as well
    std::array<ComponentSlot, kComponentCount> components{};
    std::array<AliveSlot, kComponentCount> alive{};
};

/// Storage for the components of the system table `kTable`, which has static storage.
template <const auto& kTable>
struct ExecutionStorageFor : ExecutionStorage<std::remove_reference_t<decltype(kTable)>::kComponentCount> {};

/// The first late release since the last acknowledgement, and how many there were.
struct LateRelease {
    std::uint32_t count{0U};
    std::size_t window{0U};
    Duration lateness{0};
    Instant at{};
};

/// Supervises the components of one executive. A component is identified by itself; only where the table is
/// not constant, by its index. A component of the table can refer to a supervisor that is declared before the
/// table and defined after it:
///
///     extern mamori::safety::ExecutionSupervisor supervision;
///     static Decider decider{supervision};
///     static constexpr auto kSystem = mamori::system(...);
///     static mamori::safety::ExecutionStorageFor<kSystem> storage;
///     mamori::safety::ExecutionSupervisor supervision{storage, 50_us};
///     static constexpr std::array kLimits = {mamori::safety::watch(reader, {{2U, 4U}, {0_us, 40_us}})};
///     ... supervision.watch(kLimits);
///
/// Thread safety: on_budget_overrun may be called from another context; all other members from one and the
///                same execution context.
/// Time:          step(), get_first_expired() and the functions that take a Component are O(components), the
///                others are O(1). Nothing blocks.
/// Memory:        no heap; all state is in the storage, which must outlive this object.
class ExecutionSupervisor final : public ExecutionObserver {
  public:
    /// "No component", as get_first_expired() says it.
    static constexpr std::size_t kNoComponent = static_cast<std::size_t>(-1);

    /// @param[in] storage      one slot per component of the executive; fewer are an own bug.
    /// @param[in] lateness_max latest release of a window that is tolerated, >= 0.
    template <std::size_t kComponentCount>
    constexpr ExecutionSupervisor(ExecutionStorage<kComponentCount>& storage, Duration lateness_max) noexcept
        : ExecutionObserver(storage.records),
          alive_(storage.alive),
          components_(storage.components),
          lateness_max_(lateness_max) {
        MAMORI_REQUIRE(1, lateness_max >= Duration{0});
    }

    /// @param[in] storage      of the table that the executive runs.
    /// @param[in] lateness_max as above.
    template <const auto& kTable>
    constexpr ExecutionSupervisor(ExecutionStorageFor<kTable>& storage, Duration lateness_max) noexcept
        : ExecutionSupervisor(static_cast<typename ExecutionStorageFor<kTable>::Slots&>(storage),
                              lateness_max) {
        table_components_ = kTable.components;
        mode_count_ = kTable.modes.modes.size();
        mode_members_ = kTable.modes.members;
    }

    /// @return index of the component in the table of the storage; kNoIndex: it is not in the table, or the
    ///         storage is not of a table. For a caller that needs it in each cycle.
    std::size_t find(const Component& component) const noexcept {
        return find_component(table_components_, &component);
    }

    /// Components of the table, in table order; none if the storage is not of a table.
    Span<Component* const> get_components() const noexcept { return table_components_; }

    /// Starts supervising a component, active. A component that is not watched may be silent and slow, but
    /// a budget overrun expires it all the same, with global scope.
    /// @return kOk; kBadParameter (component or limits out of range); kPreconditionNotMet (already watched).
    Status watch(std::size_t component, const ComponentLimits& limits) noexcept;
    Status watch(const Component& component, const ComponentLimits& limits) noexcept {
        return watch(find(component), limits);
    }

    /// The same for each row in order, up to the first that is rejected.
    Status watch(Span<const WatchRow> rows) noexcept;

    /// Tells that the component is meant to be silent, or to run again.
    /// @return as AliveSupervisor::deactivate and AliveSupervisor::activate.
    Status deactivate(std::size_t component) noexcept;
    Status deactivate(const Component& component) noexcept { return deactivate(find(component)); }
    Status activate(std::size_t component) noexcept { return alive_.activate(component); }
    Status activate(const Component& component) noexcept { return activate(find(component)); }

    /// Supervises the components that run in a mode of the table, and lets the others be silent. The steps of
    /// a mode switch do so by themselves; this is for the mode in which a system starts.
    /// @param[in] mode index of the mode; one that the table does not have changes nothing.
    void follow_mode(std::size_t mode) noexcept;

    /// Takes an expired component back to kOk. Only for a deliberate reset; an overrun or a run outside its
    /// limits that no step() has judged yet is kept.
    /// @return kOk; kBadParameter (component out of range); kPreconditionNotMet (not expired).
    Status acknowledge(std::size_t component) noexcept;
    Status acknowledge(const Component& component) noexcept { return acknowledge(find(component)); }

    /// Ends one supervision cycle and judges all components, worst condition first.
    /// @param[in] now start of the cycle, as in ContextHandle::now.
    /// @return kExpired: a component of global scope is expired. kFailed: one is late, a window was released
    ///         too late in this cycle, or no component of global scope is active, so that nothing is proven.
    [[nodiscard]] GlobalStatus step(Instant now) noexcept;

    /// Expires a component for a violation that another supervision found, unless it is expired. The global
    /// status of the last step() follows.
    /// @param[in] component of the table, or 0 .. count - 1; any other is a contract violation.
    /// @param[in] cause     not kNone. @param[in] now of the last step().
    void expire(std::size_t component, ExpiryCause cause, Instant now) noexcept;

    /// @return result of the last step() and of expire() since; kFailed before the first.
    GlobalStatus get_global_status() const noexcept { return global_status_; }

    /// @param[in] component of the table, or 0 .. count - 1; any other is a contract violation.
    /// @return its status at the last step().
    LocalStatus get_local_status(std::size_t component) const noexcept {
        return components_[component].status;
    }
    LocalStatus get_local_status(const Component& component) const noexcept {
        return get_local_status(find(component));
    }

    /// @param[in] component as above. @return why it expired; kNone unless it did.
    ExpiryCause get_cause(std::size_t component) const noexcept { return components_[component].cause; }
    ExpiryCause get_cause(const Component& component) const noexcept { return get_cause(find(component)); }

    /// @param[in] component as above. @return whether its expiry was found by the last step().
    bool has_just_expired(std::size_t component) const noexcept {
        return components_[component].has_just_expired;
    }

    /// @param[in] component index in the table. @return its life-cycle state; kCreated when it has no
    /// context,
    ///            or the storage is not of a table.
    LifecycleState get_state(std::size_t component) const noexcept;

    /// @return component that expired first of those still expired, the lowest index of one step;
    ///         kNoComponent when none is.
    std::size_t get_first_expired() const noexcept;

    /// @return first late release and their count since the last acknowledgement; count 0 when there was
    /// none.
    const LateRelease& get_late_release() const noexcept { return late_release_; }
    void acknowledge_late_release() noexcept { late_release_ = LateRelease{}; }

    void on_budget_overrun(std::size_t window, std::size_t component, Instant now) noexcept override;
    void on_late_release(std::size_t window, Duration lateness, Instant now) noexcept override;
    void on_mode_step(ModeStep step, std::size_t index, Instant now) noexcept override;

  private:
    /// What one component adds to the global status.
    struct Share {
        GlobalStatus status;
        bool proves_something;  ///< it is active: its health is proven when nothing speaks against it
    };
    bool runs_in(std::size_t component, std::size_t mode) const noexcept;
    void collect_overruns() noexcept;
    Share weigh(std::size_t component, Instant now) noexcept;
    void judge(std::size_t component, Instant now) noexcept;

    AliveSupervisor alive_;
    Span<ComponentSlot> components_;
    std::atomic<bool> is_overrun_pending_{false};  ///< of any component
    Duration lateness_max_;
    LateRelease late_release_{};
    bool is_release_late_{false};
    GlobalStatus global_status_{GlobalStatus::kFailed};
    Span<Component* const> table_components_{};
    std::size_t mode_count_{0U};
    Span<const ModeMemberRow> mode_members_{};
};

}  // namespace mamori::safety

#endif  // MAMORI_SAFETY_EXECUTION_SUPERVISOR_HPP
