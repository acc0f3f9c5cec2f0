// SPDX-License-Identifier: Apache-2.0
/// @file
/// Part of an executive that brings the components of one core to Active and back. Not for users.
///
/// @satisfies SWR-KRN-024, SWR-KRN-033, SWR-KRN-039, SWR-KRN-049, SWR-KRN-070, SWR-PAR-011
/// Design:   docs/design/kernel.md#parts-of-the-executive
#ifndef MAMORI_KERNEL_SYSTEM_LIFE_HPP
#define MAMORI_KERNEL_SYSTEM_LIFE_HPP

#include <cstddef>

#include "mamori/kernel/run/detail/core_state.hpp"
#include "mamori/kernel/run/detail/data_flow.hpp"
#include "mamori/kernel/run/detail/mode_follower.hpp"
#include "mamori/kernel/run/detail/window_runner.hpp"

namespace mamori::detail {

/// Each operation is the one of Executive with its name; the executive calls it only if may_...() permits it.
/// `guard` is empty or one ActionGuard; an operation with a guard is linked only if a program uses it.
///
/// Thread safety: as Executive.
/// Time:          O(components + connections + ports) of the table; initialize() also checks the table.
///                Nothing blocks beyond actions.
/// Memory:        that of WindowRunner and three members.
class SystemLife final {
  public:
    constexpr SystemLife(const CoreState& core, SystemModes* modes) noexcept : runner_(core, modes) {}
    SystemLife(const SystemLife&) = delete;
    SystemLife& operator=(const SystemLife&) = delete;

    WindowRunner& get_runner() noexcept { return runner_; }
    const DataFlow& get_data_flow() const noexcept { return runner_.get_modes().get_data_flow(); }
    CoreState& get_core() noexcept { return runner_.get_core(); }
    const CoreState& get_core() const noexcept { return get_data_flow().get_core(); }

    /// Checks the table as far as the compiler has not. initialize() does so as well.
    void check_table() noexcept;
    /// The last check_table() found no violated rule.
    bool is_table_valid() const noexcept { return is_table_valid_; }

    bool may_initialize() noexcept { return !is_initialized_ && !is_any_in_use(); }
    template <typename... Guard>
    Status initialize(Guard&... guard) noexcept;

    bool may_start() noexcept { return is_initialized_ && !is_any_in_use(); }
    template <typename... Guard>
    Status start(Guard&... guard) noexcept;

    bool may_stop() const noexcept { return is_initialized_; }
    template <typename... Guard>
    Status stop(Guard&... guard) noexcept;

    bool may_finalize() noexcept { return may_start() && !is_any_active(); }
    template <typename... Guard>
    Status finalize(Guard&... guard) noexcept;

    /// Component whose failure ended the last initialize() or start(); kNoIndex: none.
    std::size_t get_failed_component() const noexcept { return failed_component_; }

  private:
    bool is_any_in_use() noexcept;
    bool is_any_active() const noexcept;
    std::size_t find_invalid_parameter() const noexcept;
    Status prepare_initialization() noexcept;
    template <typename... Guard>
    Status initialize_components(Guard&... guard) noexcept;
    Status attach_contexts() noexcept;
    std::size_t find_component_without_context() const noexcept;
    template <typename... Guard>
    Status start_contexts(Guard&... guard) noexcept;
    template <typename... Guard>
    Status activate_components(Guard&... guard) noexcept;
    template <typename... Guard>
    Status stop_windows(Guard&... guard) noexcept;

    WindowRunner runner_;
    std::size_t failed_component_{kNoIndex};
    bool is_table_valid_{false};
    bool is_initialized_{false};
};

}  // namespace mamori::detail

#endif  // MAMORI_KERNEL_SYSTEM_LIFE_HPP
