// SPDX-License-Identifier: Apache-2.0
/// @file
/// Configuration administration: accepts requests for configuration sets and single values at any time from
/// any thread, and executes them when no component is in a cycle. A set becomes active completely or not at
/// all.
///
/// @satisfies SWR-PAR-007, SWR-PAR-008, SWR-PAR-009      Design: docs/design/parameters.md#switching
/// Source:   OpenRTM-aist ConfigAdmin; OMG Super Distributed Objects, interface Configuration
#ifndef MAMORI_KERNEL_CONFIGURATION_ADMIN_HPP
#define MAMORI_KERNEL_CONFIGURATION_ADMIN_HPP

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "mamori/kernel/base/assert.hpp"
#include "mamori/kernel/base/span.hpp"
#include "mamori/kernel/base/status.hpp"
#include "mamori/kernel/base/text.hpp"
#include "mamori/kernel/parameter/configuration_check.hpp"
#include "mamori/kernel/parameter/configuration_finding.hpp"
#include "mamori/kernel/parameter/configuration_table.hpp"
#include "mamori/kernel/parameter/parameter.hpp"

namespace mamori {

/// Index that denotes no configuration set.
inline constexpr std::size_t kNoConfigurationSet = std::numeric_limits<std::uint32_t>::max();

/// Administers the parameters of one configuration table.
///
///     mamori::ConfigurationAdmin admin{mamori::make_view(kConfiguration)};
///
/// Thread safety: requests, find() and get_active_configuration_set() from any thread, wait-free; the switch
///                and get_last_finding() only from the context that runs the components.
/// Time:          request by set name O(sets), of a value O(parameters); switch O(parameters * assignments of
///                the set), plus copying the values. Nothing blocks.
/// Memory:        no heap; refers to the table.
class ConfigurationAdmin final {
  public:
    /// @param[in] view        its table must outlive the admin; check it with MAMORI_CHECK_CONFIGURATION.
    /// @param[in] initial_set index of the set that is requested initially, 0 .. view.sets.size() - 1, or
    ///                        kNoConfigurationSet; any other value is a contract violation.
    constexpr explicit ConfigurationAdmin(const ConfigurationView& view,
                                          std::size_t initial_set = kNoConfigurationSet) noexcept
        : view_(view), requested_(static_cast<std::uint32_t>(initial_set)) {
        MAMORI_REQUIRE(1, initial_set < view.sets.size() || initial_set == kNoConfigurationSet);
    }
    ConfigurationAdmin(const ConfigurationAdmin&) = delete;
    ConfigurationAdmin& operator=(const ConfigurationAdmin&) = delete;

    /// Requests set `index` for the next switch. Only the last request before the switch takes effect.
    /// @param[in] index 0 .. get_view().sets.size() - 1.
    /// @return kOk; kBadParameter (no such set).
    Status activate_configuration_set(std::size_t index) noexcept;
    /// The same by name, which need not outlive the call. kBadParameter: no set has this name.
    Status activate_configuration_set(Text name) noexcept;

    /// Requests `value` for the next switch. A switch activates the set first, then the single values.
    /// @return kOk; kBadParameter (`value` violates the constraint, or `parameter` belongs to no component of
    ///         the table); kPreconditionNotMet (another request or the switch is accessing this parameter:
    ///         retry).
    template <typename T, std::size_t kRanges>
    Status set_value(Parameter<T, kRanges>& parameter,
                     const typename Parameter<T, kRanges>::Value& value) noexcept {
        return is_known(parameter) ? parameter.request(value) : Status::kBadParameter;
    }
    /// The same for untyped values, one per element. kBadParameter also for a wrong number or type of values.
    Status set_value(ParameterBase& parameter, Span<const Scalar> values) noexcept;

    /// @return the parameter with this name of the named component; kBadParameter (no such parameter).
    Result<ParameterBase*> find(Text component, Text parameter) const noexcept;

    /// Executes the requests, for users without an executive. Call it before on_initialize of the first
    /// component, before the first on_activated, and between two major frames. Never call it while an action
    /// of a component in the table runs or hangs; the requests wait. An executive uses the steps below
    /// instead.
    /// @return kOk (also if nothing was requested); kBadParameter (a value of the set is rejected: no value
    ///         of the set is activated, the request is discarded, and get_last_finding() identifies the
    ///         value). Single values are activated in both cases. If collect_findings() found nothing before,
    ///         only corrupted memory causes a rejection. The compiler alone cannot check values of components
    ///         without a default constructor.
    Status switch_at_frame_boundary() noexcept;

    /// @name Steps of a switch, for executives that share the parameters of one table. Each switches the
    ///       parameters of its own components, all in the same major frame.
    /// @{
    /// Takes the request for a set. @return its index; kNoConfigurationSet if none is requested.
    std::size_t take_requested_set() noexcept;
    /// Checks every value of a set; from any thread.
    /// @param[in] set index in the table; any other value is a contract violation.
    /// @return the first rejected value (kValueOutsideConstraint), or kNone.
    ConfigurationFinding judge_set(std::size_t set) const noexcept;
    /// Activates the values of a set for these parameters. Call judge_set() first: a rejected value is a
    /// contract violation here.
    void activate_set(std::size_t set, Span<const ParameterRow> parameters) noexcept;
    /// Activates the requested single values of these parameters.
    static void commit(Span<const ParameterRow> parameters) noexcept;
    /// @}

    /// Set that was activated last; kNoConfigurationSet before the first switch.
    std::size_t get_active_configuration_set() const noexcept {
        return active_.load(std::memory_order_acquire);
    }
    /// Why switch_at_frame_boundary() rejected a set last; kNone if it never did.
    const ConfigurationFinding& get_last_finding() const noexcept { return last_finding_; }
    const ConfigurationView& get_view() const noexcept { return view_; }

  private:
    bool is_known(const ParameterBase& parameter) const noexcept;
    static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

    ConfigurationView view_;
    std::atomic<std::uint32_t> requested_;
    std::atomic<std::uint32_t> active_{kNone};
    ConfigurationFinding last_finding_{};
};

}  // namespace mamori

#endif  // MAMORI_KERNEL_CONFIGURATION_ADMIN_HPP
