// SPDX-License-Identifier: Apache-2.0
/// @file
/// Takes requests for configuration sets and single values at any time and from any thread, and carries them
/// out where no component is in a cycle: all values of a set, or none.
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

/// Index that no configuration set has.
inline constexpr std::size_t kNoConfigurationSet = std::numeric_limits<std::uint32_t>::max();

/// Administers the parameters of one configuration table.
///
///     mamori::ConfigurationAdmin admin{mamori::make_view(kConfiguration)};
///
/// Thread safety: the requests, find() and get_active_configuration_set() from any thread, without waiting;
///                the switch and get_last_finding() only from the context that runs the components.
/// Time:          a request for a set by its name O(sets), for a value O(parameters); a switch O(parameters *
///                assignments of the set), beside its values. Nothing blocks.
/// Memory:        no heap; refers to the table.
class ConfigurationAdmin final {
  public:
    /// @param[in] view        its table must outlive the admin; check it with MAMORI_CHECK_CONFIGURATION.
    /// @param[in] initial_set place of the set that is requested from the start on, or none; any other number
    ///                        is an own bug.
    constexpr explicit ConfigurationAdmin(const ConfigurationView& view,
                                          std::size_t initial_set = kNoConfigurationSet) noexcept
        : view_(view), requested_(static_cast<std::uint32_t>(initial_set)) {
        MAMORI_REQUIRE(1, initial_set < view.sets.size() || initial_set == kNoConfigurationSet);
    }
    ConfigurationAdmin(const ConfigurationAdmin&) = delete;
    ConfigurationAdmin& operator=(const ConfigurationAdmin&) = delete;

    /// Asks for a set from the next switch on. Of several requests before it the last one counts.
    /// @param[in] index 0 .. get_view().sets.size() - 1.
    /// @return kOk; kBadParameter (no such set).
    Status activate_configuration_set(std::size_t index) noexcept;
    /// The same by the set's name, which need not outlive the call.
    Status activate_configuration_set(Text name) noexcept;

    /// Asks for one value from the next switch on. At one switch the set comes first, then the single values.
    /// @return kOk; kBadParameter (the constraint, or a parameter of no component in the table);
    ///         kPreconditionNotMet (another request or the switch is at this parameter: ask again).
    template <typename T, std::size_t kRanges>
    Status set_value(Parameter<T, kRanges>& parameter,
                     const typename Parameter<T, kRanges>::Value& value) noexcept {
        return is_known(parameter) ? parameter.request(value) : Status::kBadParameter;
    }
    /// The same for values without their type, one per element.
    Status set_value(ParameterBase& parameter, Span<const Scalar> values) noexcept;

    /// @return the parameter of this name in the component of this name; kBadParameter when there is none.
    Result<ParameterBase*> find(Text component, Text parameter) const noexcept;

    /// Carries the requests out, for whoever runs the components by himself: before on_initialize of the
    /// first one, before the first on_activated, and between two frames; never while an action of a component
    /// in the table is under way or hangs (the requests wait). An executive does the same in the parts below.
    /// @return kOk (also when nothing was requested); kBadParameter (a value of the set is refused: no value
    ///         of the set was switched, the request is gone and get_last_finding() names it). Single values
    ///         are switched in either case. Where collect_findings() found nothing before, only corrupted
    ///         memory can be refused; the compiler alone cannot judge what belongs to a component without a
    ///         default constructor.
    Status switch_at_frame_boundary() noexcept;

    /// @name The same in parts, for executives that share the parameters of one table: each switches those of
    /// its own components, all at the same frame
    /// @{
    /// Takes the request for a set. @return kNoConfigurationSet when there is none.
    std::size_t take_requested_set() noexcept;
    /// Judges every value of a set; from any thread.
    /// @param[in] set place in the table; any other is an own bug.
    /// @return the first one that is refused, or kNone.
    ConfigurationFinding judge_set(std::size_t set) const noexcept;
    /// Makes the values of a set active that belong to these parameters. Call it after judge_set(): a value
    /// that is refused here is an own bug.
    void activate_set(std::size_t set, Span<const ParameterRow> parameters) noexcept;
    /// Makes the single values active that were asked for.
    static void commit(Span<const ParameterRow> parameters) noexcept;
    /// @}

    /// Set that was switched last; kNoConfigurationSet before the first one.
    std::size_t get_active_configuration_set() const noexcept {
        return active_.load(std::memory_order_acquire);
    }
    /// What refused the last set that switch_at_frame_boundary() did not switch.
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
