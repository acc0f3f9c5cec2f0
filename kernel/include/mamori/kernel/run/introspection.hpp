// SPDX-License-Identifier: Apache-2.0
/// @file
/// Lets tools inspect a running system without influence on it: the executives write copies of their state to
/// snapshot cells, and any number of readers read them.
///
///     static mamori::IntrospectionFor introspection{kSystem};
///     executive.set_introspection(&introspection);
///     const mamori::Introspection& shown = introspection;        // sufficient for a tool
///     shown.for_each_window([](std::size_t, const mamori::WindowSnapshot& window) noexcept { ... });
///
/// @satisfies SWR-INS-001, SWR-INS-002, SWR-INS-003, SWR-INS-004, SWR-INS-005, SWR-PRT-036
/// Design:   docs/design/kernel.md#introspection
#ifndef MAMORI_KERNEL_INTROSPECTION_HPP
#define MAMORI_KERNEL_INTROSPECTION_HPP

#include <array>
#include <cstddef>
#include <cstdint>

#include "mamori/kernel/base/span.hpp"
#include "mamori/kernel/dataflow/snapshot_cell.hpp"
#include "mamori/kernel/run/detail/execution_display.hpp"
#include "mamori/kernel/run/introspection_rows.hpp"

namespace mamori {

namespace detail {
/// A row: `kept` is the working copy of its core, `cell` the copy for readers.
template <typename Row>
struct ShownRow {
    Row kept{};
    SnapshotCell<Row> cell{};
};

/// Reads one row. @return as Introspection::read_window().
template <typename Row>
Status read_row(Span<ShownRow<Row>> rows, std::size_t index, Row& snapshot) noexcept {
    return index < rows.size() ? rows[index].cell.try_read(snapshot) : Status::kBadParameter;
}
template <typename Row, typename Visitor>
std::size_t visit_rows(Span<ShownRow<Row>> rows, Visitor& visitor) noexcept {
    std::size_t missed_count = 0U;
    for (std::size_t i = 0U; i < rows.size(); ++i) {
        Row snapshot{};
        if (rows[i].cell.try_read(snapshot) == Status::kOk) {
            visitor(i, snapshot);
        } else {
            ++missed_count;
        }
    }
    return missed_count;
}
}  // namespace detail

/// Size-free introspection of one system with any number of cores; instantiate IntrospectionFor.
///
/// Thread safety: const members for any number of readers, at any time. The other members are for the
///                executives, each of which writes the rows of its own core.
/// Time:          the executive shows a window wait-free, in O(windows of the table + components and ports of
///                the window); one read is O(1), read_core() O(windows). Nothing blocks.
/// Memory:        no heap; refers to the table, and while a window is shown to its components and ports. One
/// row
///                of stack per call.
class Introspection : public detail::ExecutionDisplay {
  public:
    Introspection(const Introspection&) = delete;
    Introspection& operator=(const Introspection&) = delete;

    /// @name For tools. Row and core numbers are those of the system table. Each row is consistent; rows
    ///       belong to the same cycle if their observed_at are equal.
    /// @param[out] snapshot written only if kOk is returned.
    /// @return kOk; kBadParameter (no such row); kPreconditionNotMet (the row was not published yet, for
    ///         example before an executive of its core is attached); kOutOfResources (the executive overwrote
    ///         the row during each of SnapshotCell::kTries attempts: retry).
    /// @{
    Status read_core(std::size_t core, CoreSnapshot& snapshot) const noexcept {
        return detail::read_row(cores_, find_core_row(core), snapshot);
    }
    Status read_window(std::size_t index, WindowSnapshot& snapshot) const noexcept {
        return detail::read_row(windows_, index, snapshot);
    }
    Status read_component(std::size_t index, ComponentSnapshot& snapshot) const noexcept {
        return detail::read_row(components_, index, snapshot);
    }
    Status read_port(std::size_t index, PortSnapshot& snapshot) const noexcept {
        return detail::read_row(ports_, index, snapshot);
    }
    /// @}

    /// @name For tools: all rows in table order.
    /// @param[in] visitor called in the context of the caller as visitor(index, snapshot) for each readable
    ///                    row.
    /// @return number of rows that could not be read; causes as for the read functions above.
    /// @{
    template <typename Visitor>
    std::size_t for_each_window(Visitor&& visitor) const noexcept {
        return detail::visit_rows(windows_, visitor);
    }
    template <typename Visitor>
    std::size_t for_each_component(Visitor&& visitor) const noexcept {
        return detail::visit_rows(components_, visitor);
    }
    template <typename Visitor>
    std::size_t for_each_port(Visitor&& visitor) const noexcept {
        return detail::visit_rows(ports_, visitor);
    }
    /// @}

    /// Number of rows in the table, readable or not.
    std::size_t get_window_count() const noexcept { return windows_.size(); }
    std::size_t get_component_count() const noexcept { return components_.size(); }
    std::size_t get_port_count() const noexcept { return ports_.size(); }

    /// @name For the executive of the core that owns the row
    /// @{
    // Inline, so that the object code of a user holds the virtual table and its type information, which the
    // kernel is compiled without.
    void show_windows(const detail::CoreState& core, std::uint64_t trace_hash) noexcept override {
        publish_windows(core, trace_hash);
    }
    void show_window(std::size_t window, const ExecutionContext& context, Instant release, Instant start,
                     WindowOutcome outcome, const WindowHost& host,
                     std::uint64_t trace_hash) noexcept override {
        note_opening(window, start - release, host.get_now() - start, outcome);
        publish_window(window, context, release, trace_hash);
    }
    void note_turns(std::size_t window, std::size_t finished_count,
                    const ExecutionContext& context) noexcept override {
        count_turns(window, finished_count, context);
    }
    void note_used(std::size_t component, Duration used) noexcept override { raise_used(component, used); }
    /// Whether its rows are those of `view`.
    bool is_of(const SystemView& view) const noexcept {
        return view_.components.data() == view.components.data();
    }
    /// @}

  protected:
    template <typename Rows>
    constexpr Introspection(const SystemView& view, Rows& rows) noexcept
        : view_(view),
          cores_(rows.cores),
          windows_(rows.windows),
          components_(rows.components),
          ports_(rows.ports) {}
    ~Introspection() = default;

  private:
    void publish_windows(const detail::CoreState& core, std::uint64_t trace_hash) noexcept;
    void count_turns(std::size_t window, std::size_t finished_count,
                     const ExecutionContext& context) noexcept;
    void raise_used(std::size_t component, Duration used) noexcept;
    void note_opening(std::size_t window, Duration lateness, Duration used, WindowOutcome outcome) noexcept;
    void publish_window(std::size_t window, const ExecutionContext& context, Instant opening,
                        std::uint64_t trace_hash) noexcept;
    std::size_t find_core_row(std::size_t core) const noexcept;
    void publish_component(std::size_t index, LifecycleState state, Instant opening) noexcept;
    void publish_port(std::size_t index, Instant opening) noexcept;

    SystemView view_;
    Span<detail::ShownRow<CoreSnapshot>> cores_;  ///< the row of a core has the index of its first window
    Span<detail::ShownRow<WindowSnapshot>> windows_;
    Span<detail::ShownRow<ComponentSnapshot>> components_;
    Span<detail::ShownRow<PortSnapshot>> ports_;
};

namespace detail {
/// Base so that the rows exist before the introspection that refers to them.
template <typename Table>
struct IntrospectionRows {
    std::array<ShownRow<CoreSnapshot>, Table::kWindowCount> cores{};
    std::array<ShownRow<WindowSnapshot>, Table::kWindowCount> windows{};
    std::array<ShownRow<ComponentSnapshot>, Table::kComponentCount> components{};
    std::array<ShownRow<PortSnapshot>, Table::kPortCount> ports{};
};
}  // namespace detail

/// Introspection with the storage that `Table` needs.
template <typename Table>
class IntrospectionFor final : private detail::IntrospectionRows<Table>, public Introspection {
  public:
    /// @param[in] table the table that the executives run; must outlive the introspection.
    constexpr explicit IntrospectionFor(const Table& table) noexcept
        : Introspection(make_view(table), static_cast<detail::IntrospectionRows<Table>&>(*this)) {}
    explicit IntrospectionFor(const Table&& table) = delete;
};

}  // namespace mamori

#endif  // MAMORI_KERNEL_INTROSPECTION_HPP
