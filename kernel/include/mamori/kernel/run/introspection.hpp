// SPDX-License-Identifier: Apache-2.0
/// @file
/// Lets tools look at a running system without its taking notice: the executives put copies of what they
/// know into snapshot cells, and any number of readers take them out again.
///
///     static mamori::IntrospectionFor introspection{kSystem};
///     executive.set_introspection(&introspection);
///     const mamori::Introspection& shown = introspection;        // all that a tool needs
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
#include "mamori/kernel/run/introspection_rows.hpp"

namespace mamori {

namespace detail {
/// What is kept of a row by its core, and what is shown of it to the readers.
template <typename Row>
struct ShownRow {
    Row kept{};
    SnapshotCell<Row> cell{};
};

/// Rows of one kind, as a reader may use them.
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

/// Size-free introspection of one system, whatever its number of cores; instantiate IntrospectionFor.
///
/// Thread safety: const members for any number of readers, at any time; the others for the executives, each
///                of which writes the rows of its own core.
/// Time:          publish_window() is wait-free and O(windows of the table + components and ports of the
///                window); one read is O(1), read_core() O(windows). Nothing blocks.
/// Memory:        no heap; refers to the table, and from publish_window() to its components and ports. One
///                row of stack per call.
class Introspection {
  public:
    Introspection(const Introspection&) = delete;
    Introspection& operator=(const Introspection&) = delete;

    /// @name For tools. Rows are those of the system table, and cores have the numbers that it gives them.
    /// Each row is whole in itself; rows belong to one cycle when their observed_at are equal.
    /// @param[out] snapshot written on kOk only.
    /// @return kOk; kBadParameter (there is no such row); kPreconditionNotMet (nothing of it was shown yet,
    ///         as before an executive of its core is attached); kOutOfResources (the executive was faster in
    ///         each of SnapshotCell::kTries tries: ask again).
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

    /// @name For tools: all rows in order.
    /// @param[in] visitor called as visitor(index, snapshot) for each row that can be read, by the caller.
    /// @return how many could not, for a reason that the read functions above name.
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

    /// Rows of the table, whether they can be read or not.
    std::size_t get_window_count() const noexcept { return windows_.size(); }
    std::size_t get_component_count() const noexcept { return components_.size(); }
    std::size_t get_port_count() const noexcept { return ports_.size(); }

    /// @name For the executive of the core that the row belongs to. An index that is not of the table is an
    /// own bug.
    /// @{
    /// An opening of `window` is over. @param[in] lateness, used >= 0.
    void note_opening(std::size_t window, Duration lateness, Duration used, WindowOutcome outcome) noexcept;
    /// The first `finished_count` components of `window` came through their first pass within the budget.
    void note_turns(std::size_t window, std::size_t finished_count, const ExecutionContext& context) noexcept;
    /// The first pass of `component` took `used`. Also from an action that its host has abandoned, while it
    /// still counts as hanging.
    void note_used(std::size_t component, Duration used) noexcept;
    /// Shows the rows of `window`, of a table that keeps the rules. @param[in] opening planned opening that
    /// ran last. @param[in] trace_hash of its core, after it.
    void publish_window(std::size_t window, const ExecutionContext& context, Instant opening,
                        std::uint64_t trace_hash) noexcept;
    /// True when its rows are those of `view`.
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
    std::size_t find_core_row(std::size_t core) const noexcept;
    void publish_component(std::size_t index, LifecycleState state, Instant opening) noexcept;
    void publish_port(std::size_t index, Instant opening) noexcept;

    SystemView view_;
    Span<detail::ShownRow<CoreSnapshot>> cores_;  ///< that of a core is at the place of its first window
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
    /// @param[in] table must outlive the introspection; the one that the executives run.
    constexpr explicit IntrospectionFor(const Table& table) noexcept
        : Introspection(make_view(table), static_cast<detail::IntrospectionRows<Table>&>(*this)) {}
    explicit IntrospectionFor(const Table&& table) = delete;
};

}  // namespace mamori

#endif  // MAMORI_KERNEL_INTROSPECTION_HPP
