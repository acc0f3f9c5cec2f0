// SPDX-License-Identifier: Apache-2.0
/// @file
/// Modes and parameters of a running system. Accepts requests from any thread and makes all cores execute
/// them in the same major frame, step by step. A failed step leads to the safe mode, latched.
///
/// @satisfies SWR-MOD-004, SWR-MOD-005, SWR-MOD-006, SWR-MOD-007, SWR-MOD-010
/// Design:   docs/design/modes.md#the-switch
#ifndef MAMORI_KERNEL_SYSTEM_MODES_HPP
#define MAMORI_KERNEL_SYSTEM_MODES_HPP

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "mamori/kernel/base/assert.hpp"
#include "mamori/kernel/base/enumerator.hpp"
#include "mamori/kernel/base/status.hpp"
#include "mamori/kernel/parameter/configuration_admin.hpp"
#include "mamori/kernel/run/detail/mode_execution.hpp"
#include "mamori/kernel/run/detail/mode_plan.hpp"
#include "mamori/kernel/run/mode_step.hpp"
#include "mamori/kernel/table/system_table.hpp"

namespace mamori {

/// Maximum number of cores that share a SystemModes.
inline constexpr std::size_t kModeCoreMax = 8U;
/// From the major frame of a request to the one in which all cores execute it [major frames].
inline constexpr std::int64_t kModeRequestFrames = 2;
/// Distance of two steps of a switch [major frames]: in the first frame the step is executed, in the second
/// each core reports, in the third the next step is agreed.
inline constexpr std::int64_t kModeStepFrames = 3;

/// One per system, shared by the executives of its cores:
///
///     MAMORI_CONSTINIT mamori::SystemModes modes{mamori::make_view(kSystem)};
///     MAMORI_CONSTINIT mamori::ExecutiveFor core_0{kSystem, modes};
///     MAMORI_CONSTINIT mamori::ExecutiveFor core_1{kSystem, modes, 1U};
///     ... modes.request(Command::kTeach);
///
/// Thread safety: requests and get_...() from any thread, wait-free; the functions for executives by each
///                core from its own context.
/// Time:          O(transitions) for a request; O(cores) per major frame; O(values of the set) in prepare()
///                and in the major frame in which a step with a set ends. Nothing blocks.
/// Memory:        no heap; refers to the table.
class SystemModes final : public detail::ModeExecution {
  public:
    /// @param[in] view        its table must outlive this object; check it with MAMORI_CHECK. More than 4095
    ///                        configuration sets are a contract violation.
    /// @param[in] initial_set for a table without modes: index of the set that is requested initially, or
    ///                        kNoConfigurationSet; any other value is a contract violation.
    constexpr explicit SystemModes(const SystemView& view,
                                   std::size_t initial_set = kNoConfigurationSet) noexcept
        : view_(view),
          safe_mode_(find_safe_mode(view.modes)),
          configuration_(view.configuration, initial_set),
          set_(find_first_set(view.modes)) {
        MAMORI_REQUIRE(1, view.configuration.sets.size() <= ModePlan::kIndexMax);
    }
    SystemModes(const SystemModes&) = delete;
    SystemModes& operator=(const SystemModes&) = delete;

    /// Requests the transition of `event` in the current mode.
    /// @param[in] event enumerator of a mode_transition(); an enumerator of another enumeration is not an
    ///                  event (a table with directly filled rows accepts any enumeration with the same
    ///                  number).
    /// @return kOk: the cores execute it two major frames later; kBadParameter (no transition has this
    ///         event); kPreconditionNotMet (no such transition in this mode, another request is pending, a
    ///         mode switch is in progress, or a failure is latched: retry, or reset).
    template <typename Event>
    Status request(Event event) noexcept {
        return request_event(detail::to_number(event), &detail::kEnumerationTag<Event>);
    }
    /// Requests the safe mode at any time; never rejected if the table has one.
    /// @return kOk; kUnsupported (the table has no safe mode).
    Status request_safe_mode() noexcept;
    /// Accepts requests for sets and values of parameters at any time; the executives execute them. A
    /// requested set waits for the end of a mode switch. It stays active until the next mode with its own
    /// set.
    ConfigurationAdmin& get_configuration() noexcept { return configuration_; }

    /// Current mode of all cores, as its index in the table. During a mode switch: the previous mode. Without
    /// modes: 0.
    std::size_t get_mode() const noexcept { return mode_.load(std::memory_order_acquire); }
    /// The same as the enumerator of system_mode<...>().
    /// @tparam Mode enumeration of the modes of the table; any other, or a table whose modes have names only,
    ///              is a contract violation.
    template <typename Mode>
    Mode get_mode() const noexcept {
        static_assert(std::is_enum_v<Mode>, "a mode is an enumerator: get_mode<Mode>()");
        MAMORI_REQUIRE(2, view_.modes.mode_enumeration == &detail::kEnumerationTag<Mode>);
        return static_cast<Mode>(get_mode());
    }
    /// The step that is agreed and not completed; kNone if no switch is in progress.
    ModeStep get_step() const noexcept { return ModePlan{plan_.load(std::memory_order_acquire)}.get_step(); }
    /// First failure since the last reset; cause kNone: none. While a failure is latched, a table
    /// with a safe mode rejects request().
    ModeFailure get_failure() const noexcept;
    /// Clears the failure and a pending request, and returns to the first mode. Must be a deliberate act of
    /// an operator.
    /// @return kOk; kPreconditionNotMet (an executive is running).
    Status reset() noexcept;

    /// @name For executives
    /// @{
    /// Whether it was constructed from the table of `view`.
    bool is_of(const SystemView& view) const noexcept {
        return view_.components.data() == view.components.data() &&
               view_.modes.modes.size() == view.modes.modes.size();
    }
    /// Determines the set to activate before a component runs; kNoConfigurationSet: parameters keep their
    /// values.
    /// @return the set; kBadParameter (a value is rejected of this set, or of a set that was requested while
    ///         no core ran: that request is discarded).
    Result<std::size_t> prepare() noexcept;
    /// Reports that the core starts. @param[in] core < kModeCoreMax, here and below; Executive::initialize()
    /// ensures it.
    /// @return kOk; kPreconditionNotMet (other cores are switching).
    Status join(std::size_t core) noexcept;
    /// Reports that the core has stopped. The last core ends a mode switch in progress in the safe mode.
    void leave(std::size_t core) noexcept;
    /// Agrees on the next step if this core has to; call once per major frame of a core that has joined.
    /// @param[in] frame number of the major frame since instant 0, equal on each core.
    /// @return the agreed plan, due or not.
    ModePlan begin_frame(std::size_t core, std::int64_t frame) noexcept;
    /// Reports that the core has executed the plan, or that it has reported its failure.
    void finish(std::size_t core, ModePlan plan) noexcept {
        finished_[core].store(plan.get_word(), std::memory_order_release);
    }
    /// Latches a failure. @return true if it is the first failure since the last reset.
    bool fail(const ModeFailure& failure) noexcept;
    /// @}

  private:
    Status initialize_core(detail::ModeFollower& follower) noexcept override;
    Status join_core(detail::ModeFollower& follower) noexcept override;
    void leave_core(detail::ModeFollower& follower) noexcept override;
    void begin_core_frame(detail::ModeFollower& follower) noexcept override;
    std::size_t open_window(detail::ModeFollower& follower, detail::WindowState& state, Instant deadline,
                            WindowHost& host) noexcept override;
    std::size_t close_window(detail::ModeFollower& follower, detail::WindowState& state, Instant deadline,
                             WindowHost& host) noexcept override;

    static constexpr std::uint32_t find_first_set(const ModeView& view) noexcept {
        return view.modes.empty() || view.modes[0U].set == kNoIndex
                   ? static_cast<std::uint32_t>(kNoConfigurationSet)
                   : static_cast<std::uint32_t>(view.modes[0U].set);
    }
    Status request_event(std::uint32_t event, const std::uint8_t* enumeration) noexcept;
    bool is_lead(std::size_t core) const noexcept;
    bool is_finished(ModePlan plan) const noexcept;
    bool is_failing() const noexcept;
    void replace(ModePlan old, ModePlan next) noexcept;
    void conclude(ModePlan plan, std::int64_t frame) noexcept;
    void propose(std::int64_t frame) noexcept;
    void enter_safe_mode_when_failing() noexcept;
    bool hold(std::size_t set) noexcept;
    void enter(std::size_t mode) noexcept;
    bool is_failure_unserved(std::size_t core) noexcept;

    SystemView view_;
    std::size_t safe_mode_;
    ConfigurationAdmin configuration_;
    std::atomic<std::size_t> mode_{0U};
    std::atomic<std::uint32_t> set_;          ///< active set: of a mode, or requested separately
    std::atomic<std::uint32_t> request_{0U};  ///< index of a requested transition, plus one; 0: none
    std::atomic<std::uint32_t> plan_{0U};
    std::atomic<std::uint32_t> failure_{0U};
    std::atomic<std::uint32_t> running_{0U};                           ///< bit c: core c
    std::array<std::atomic<std::uint32_t>, kModeCoreMax> finished_{};  ///< plan that the core finished last

    /// Major frames for which a failure has waited for the coordinator core; one element per core.
    std::array<std::int64_t, kModeCoreMax> unserved_frames_{};

    /// Major frames after which another core acts instead of the coordinator core.
    static constexpr std::int64_t kLeadPatience = 2 * kModeStepFrames;
};

}  // namespace mamori

#endif  // MAMORI_KERNEL_SYSTEM_MODES_HPP
