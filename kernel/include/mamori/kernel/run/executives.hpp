// SPDX-License-Identifier: Apache-2.0
/// @file
/// All executives of one system: one for each core of its table, one for the background windows of each core
/// that has some, and the SystemModes that they share.
///
/// @satisfies SWR-KRN-074      Design: docs/design/kernel.md#machine
#ifndef MAMORI_KERNEL_EXECUTIVES_HPP
#define MAMORI_KERNEL_EXECUTIVES_HPP

#include <array>
#include <cstddef>
#include <type_traits>
#include <utility>

#include "mamori/kernel/base/assert.hpp"
#include "mamori/kernel/base/span.hpp"
#include "mamori/kernel/base/status.hpp"
#include "mamori/kernel/run/action_guard.hpp"
#include "mamori/kernel/run/executive.hpp"
#include "mamori/kernel/run/system_modes.hpp"
#include "mamori/kernel/table/checked_table.hpp"
#include "mamori/kernel/table/system_table.hpp"

namespace mamori {

namespace detail {

/// @return number of executives: that of the highest core with a window, plus one.
constexpr std::size_t count_cores(const SystemView& view) noexcept {
    std::size_t count = 0U;
    for (const WindowRow& window : view.windows) {
        count = window.core < count ? count : window.core + 1U;
    }
    return count;
}

/// @return processor core whose background windows executive `core` runs; kNoIndex: it runs ordinary windows.
constexpr std::size_t find_background_of(const SystemView& view, std::size_t core) noexcept {
    for (const WindowRow& window : view.windows) {
        if (window.core == core) {
            return window.background_of;
        }
    }
    return kNoIndex;
}

/// @return number of executives of ordinary windows, of a table that system() has made.
constexpr std::size_t count_processors(const SystemView& view) noexcept {
    std::size_t count = 0U;
    for (const WindowRow& window : view.windows) {
        const std::size_t core = is_background(window) ? window.background_of : window.core;
        count = core < count ? count : core + 1U;
    }
    return count;
}

/// @return the lowest core with a window, which calls the devices; 0 without a window.
constexpr std::size_t find_first_core(const SystemView& view) noexcept {
    std::size_t first = view.windows.empty() ? 0U : view.windows[0U].core;
    for (const WindowRow& window : view.windows) {
        first = window.core < first ? window.core : first;
    }
    return first;
}

template <const auto& kTable>
using TableType = std::remove_const_t<std::remove_reference_t<decltype(kTable)>>;

template <const auto& kTable, bool kNeedsModes>
struct ModesSlot {
    SystemModes modes{make_view(kTable)};
};
template <const auto& kTable>
struct ModesSlot<kTable, false> {};

template <const auto& kTable, std::size_t kCore>
struct ExecutiveSlot {
    ExecutiveFor<TableType<kTable>> executive;

    constexpr explicit ExecutiveSlot(ModesSlot<kTable, false>&) noexcept
        : executive(kChecked<kTable>, kCore) {}
    constexpr explicit ExecutiveSlot(ModesSlot<kTable, true>& slot) noexcept
        : executive(kChecked<kTable>, slot.modes, kCore) {}
};

/// Base so that the pointers exist before the group that refers to them.
template <std::size_t kCount>
struct ExecutiveArray {
    std::array<Executive*, kCount> executives;
};

}  // namespace detail

/// The executives of a system as one. Users construct an Executives.
///
/// Thread safety: as Executive; each core runs its windows in its own context, after start() has returned.
/// Memory:        refers to the executives.
class ExecutiveGroup {
  public:
    ExecutiveGroup(const ExecutiveGroup&) = delete;
    ExecutiveGroup& operator=(const ExecutiveGroup&) = delete;

    std::size_t size() const noexcept { return executives_.size(); }
    /// @param[in] core 0 .. size() - 1; out of range is a contract violation.
    Executive& get(std::size_t core) noexcept {
        MAMORI_REQUIRE(1, core < executives_.size());
        return *executives_[core];
    }

    /// Initialises all executives, core 0 first, then starts them. Initialised executives are only started,
    /// so a stopped system can be started again. After a failure, all executives are stopped.
    /// @return kOk; else the first failure of Executive::initialize() or start(); get_failed_core() names its
    ///         core.
    Status start() noexcept;
    /// Stops all executives, the last core first; none may run a window. @return kOk; else the first failure
    /// of Executive::stop(), which prevents no other stop.
    Status stop() noexcept;

    /// @name The same with a guard per core. @param[in] guards at least size(); each of its own executive.
    /// @{
    Status start(Span<ActionGuard* const> guards) noexcept;
    Status stop(Span<ActionGuard* const> guards) noexcept;
    /// @}

    /// Core whose failure ended the last start(); kNoIndex: no core failed.
    std::size_t get_failed_core() const noexcept { return failed_core_; }

  protected:
    constexpr explicit ExecutiveGroup(Span<Executive* const> executives) noexcept : executives_(executives) {}
    ~ExecutiveGroup() = default;

  private:
    template <typename... Guards>
    Status start_by(const Guards&... guards) noexcept;
    template <typename... Guards>
    Status stop_by(const Guards&... guards) noexcept;

    Span<Executive* const> executives_;
    std::size_t initialized_count_{0U};  ///< executives whose initialize() succeeded, core 0 first
    std::size_t failed_core_{kNoIndex};
};

template <const auto& kTable,
          typename Cores = std::make_index_sequence<detail::count_cores(make_view(kTable))>>
class Executives;

/// Storage and executives for each core of a constexpr table.
///
///     MAMORI_CHECK(kSystem);
///     static mamori::Executives<kSystem> executives;
///
/// @tparam kTable as of CheckedTable.
template <const auto& kTable, std::size_t... kCores>
class Executives<kTable, std::index_sequence<kCores...>> final
    : private detail::ModesSlot<kTable, detail::TableType<kTable>::kNeedsModes>,
      private detail::ExecutiveSlot<kTable, kCores>...,
      private detail::ExecutiveArray<sizeof...(kCores)>,
      public ExecutiveGroup {
    using Modes = detail::ModesSlot<kTable, detail::TableType<kTable>::kNeedsModes>;
    using Array = detail::ExecutiveArray<sizeof...(kCores)>;

  public:
    static constexpr std::size_t kCoreCount = sizeof...(kCores);

    constexpr Executives() noexcept
        : detail::ExecutiveSlot<kTable, kCores>(static_cast<Modes&>(*this))...,
          Array{{{&static_cast<detail::ExecutiveSlot<kTable, kCores>&>(*this).executive...}}},
          ExecutiveGroup(Array::executives) {}

    /// Only for a table with modes or configuration sets.
    constexpr SystemModes& get_modes() noexcept {
        static_assert(detail::TableType<kTable>::kNeedsModes,
                      "the table has neither modes nor configuration sets");
        return Modes::modes;
    }
};

}  // namespace mamori

#endif  // MAMORI_KERNEL_EXECUTIVES_HPP
