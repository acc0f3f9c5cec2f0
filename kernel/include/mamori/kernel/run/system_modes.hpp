// SPDX-License-Identifier: Apache-2.0
/// @file
/// Modes and parameters of one system while it runs: takes requests from any thread and makes all cores carry
/// them out at the same frame, step by step; a step that fails ends in the safe mode, latched.
///
/// @satisfies SWR-MOD-004, SWR-MOD-005, SWR-MOD-006, SWR-MOD-007
/// Design:   docs/design/modes.md#the-switch
#ifndef MAMORI_KERNEL_SYSTEM_MODES_HPP
#define MAMORI_KERNEL_SYSTEM_MODES_HPP

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>

#include "mamori/kernel/base/assert.hpp"
#include "mamori/kernel/base/enumerator.hpp"
#include "mamori/kernel/base/status.hpp"
#include "mamori/kernel/parameter/configuration_admin.hpp"
#include "mamori/kernel/run/detail/mode_plan.hpp"
#include "mamori/kernel/run/mode_step.hpp"
#include "mamori/kernel/table/system_table.hpp"

namespace mamori {

/// Cores that can share a SystemModes.
inline constexpr std::size_t kModeCoreMax = 8U;
/// From the frame in which a request is made to the one at which all cores take it.
inline constexpr std::int64_t kModeRequestFrames = 2;
/// From one step of a switch to the next: the step's frame, one in which each core reports, and one in which
/// the next step is agreed.
inline constexpr std::int64_t kModeStepFrames = 3;

/// One per system, shared by the executives of its cores:
///
///     MAMORI_CONSTINIT mamori::SystemModes modes{mamori::make_view(kSystem)};
///     MAMORI_CONSTINIT mamori::ExecutiveFor core_0{kSystem, modes};
///     MAMORI_CONSTINIT mamori::ExecutiveFor core_1{kSystem, modes, 1U};
///     ... modes.request(Command::kTeach);
///
/// Thread safety: requests and get_...() from any thread, without waiting; the part for executives each core
///                from its own context.
/// Time:          O(transitions) for a request; O(cores) per frame, and O(values of the set) in the one in
///                which a step with a set is over, and for prepare(). Nothing blocks.
/// Memory:        no heap; refers to the table.
class SystemModes final {
  public:
    /// @param[in] view        its table must outlive this object; check it with MAMORI_CHECK. More than 4095
    ///                        configuration sets are an own bug.
    /// @param[in] initial_set meant for a table without modes: place of the set that is requested from the
    ///                        start on, or none; any other number is an own bug.
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

    /// Asks for the transition that `event` has in the current mode.
    /// @param[in] event enumerator of a mode_transition(); those of another enumeration are no events (but a
    ///            table whose rows were filled by hand takes any that has the number).
    /// @return kOk: the cores take it two frames later; kBadParameter (no transition has this event);
    ///         kPreconditionNotMet (none in this mode, another request waits, a switch is under way, or a
    ///         failure is latched: ask again, or reset).
    template <typename Event>
    Status request(Event event) noexcept {
        return request_event(detail::to_number(event), &detail::kEnumerationTag<Event>);
    }
    /// Asks for the safe mode, whatever is under way; never refused where there is one.
    /// @return kOk; kUnsupported (the table has no safe mode).
    Status request_safe_mode() noexcept;
    /// Sets and values of parameters, to be asked for at any time; switching them is left to the executives.
    /// A set that is asked for beside the modes waits for the end of a switch and holds until the next mode
    /// with a set of its own.
    ConfigurationAdmin& get_configuration() noexcept { return configuration_; }

    /// The mode that all cores are in, as its place in the table; during a switch the one that they come
    /// from; 0 in a system without modes.
    std::size_t get_mode() const noexcept { return mode_.load(std::memory_order_acquire); }
    /// The step that is agreed and not over; kNone when no switch is under way.
    ModeStep get_step() const noexcept { return ModePlan{plan_.load(std::memory_order_acquire)}.get_step(); }
    /// First failure since the last reset; while there is one, requests are refused. Cause kNone: none.
    ModeFailure get_failure() const noexcept;
    /// Forgets the failure and a request that waits, and goes back to the first mode. A deliberate act of an
    /// operator.
    /// @return kOk; kPreconditionNotMet (an executive is running).
    Status reset() noexcept;

    /// @name For executives
    /// @{
    /// True when it was made of the table of `view`.
    bool is_of(const SystemView& view) const noexcept {
        return view_.components.data() == view.components.data() &&
               view_.modes.modes.size() == view.modes.modes.size();
    }
    /// Set that parameters must have before any component runs; kNoConfigurationSet: their own values.
    /// @return kBadParameter: a value of it is refused, or of one that was asked for while nothing ran; that
    ///         request is gone then.
    Result<std::size_t> prepare() noexcept;
    /// The core starts. @param[in] core < kModeCoreMax, here and below; Executive::initialize() sees to it.
    /// @return kOk; kPreconditionNotMet (a switch is under way on other cores).
    Status join(std::size_t core) noexcept;
    /// The core has stopped. The last one ends a switch that is under way: in the safe mode.
    void leave(std::size_t core) noexcept;
    /// Agrees on what comes next, when that is this core's business; once per frame of a core that has
    /// joined.
    /// @param[in] frame number of the frame since instant 0, the same on each core.
    /// @return the plan that is agreed, due or not.
    ModePlan begin_frame(std::size_t core, std::int64_t frame) noexcept;
    /// The core has carried the plan out, or knows and has reported that it failed.
    void finish(std::size_t core, ModePlan plan) noexcept {
        finished_[core].store(plan.get_word(), std::memory_order_release);
    }
    /// @return true when it is the first failure since the last reset.
    bool fail(const ModeFailure& failure) noexcept;
    /// @}

  private:
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
    std::atomic<std::uint32_t> set_;          ///< that holds: of a mode, or asked for beside them
    std::atomic<std::uint32_t> request_{0U};  ///< place of a transition with the event, plus one
    std::atomic<std::uint32_t> plan_{0U};
    std::atomic<std::uint32_t> failure_{0U};
    std::atomic<std::uint32_t> running_{0U};                           ///< bit c: core c
    std::array<std::atomic<std::uint32_t>, kModeCoreMax> finished_{};  ///< plan that the core finished last

    /// How long a failure has waited for the lead; each core has its own.
    std::array<std::int64_t, kModeCoreMax> unserved_frames_{};

    /// Frames after which another core does what the lead should have done.
    static constexpr std::int64_t kLeadPatience = 2 * kModeStepFrames;
};

}  // namespace mamori

#endif  // MAMORI_KERNEL_SYSTEM_MODES_HPP
