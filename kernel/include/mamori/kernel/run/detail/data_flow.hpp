// SPDX-License-Identifier: Apache-2.0
/// @file
/// Part of an executive that moves the values of one core: from published outputs to inputs, forward within a
/// window, and into publication. Not for users.
///
/// @satisfies SWR-KRN-021, SWR-KRN-022, SWR-KRN-023, SWR-KRN-026, SWR-KRN-039, SWR-KRN-050, SWR-KRN-054,
///            SWR-KRN-055, SWR-MOD-009
/// Design:   docs/design/kernel.md#parts-of-the-executive, docs/design/kernel.md#connections
#ifndef MAMORI_KERNEL_DATA_FLOW_HPP
#define MAMORI_KERNEL_DATA_FLOW_HPP

#include <cstddef>
#include <cstdint>

#include "mamori/kernel/payload/trace_hash.hpp"
#include "mamori/kernel/run/detail/core_state.hpp"

namespace mamori::detail {

/// Thread safety: as Executive.
/// Time:          O(connections + ports) of the window or component; clear_ports() and attach_inputs() of the
///                table. Nothing blocks.
/// Memory:        the state of the core and the trace hash.
class DataFlow final {
  public:
    constexpr explicit DataFlow(const CoreState& core) noexcept : core_(core) {}
    DataFlow(const DataFlow&) = delete;
    DataFlow& operator=(const DataFlow&) = delete;

    /// State that all parts of the executive use.
    CoreState& get_core() noexcept { return core_; }
    const CoreState& get_core() const noexcept { return core_; }

    /// Gives the inputs of the core the age limits of their connections.
    void attach_inputs() noexcept;
    /// The inputs of the core no longer refer to the table.
    void detach_inputs() noexcept;
    /// Removes each value of an earlier run that a port of the core stores or that is pending for an input.
    void clear_ports() noexcept;

    /// Copies the published values to the inputs of the window.
    void latch_inputs(const WindowRow& row, ModeMask held) noexcept;
    /// Forwards the values that `component` wrote to later components of its window. Static, because a step
    /// calls it, also one whose work was aborted.
    static void forward_outputs(const SystemView& view, std::size_t component, Instant release,
                                ModeMask held) noexcept;
    /// Ends the read pass of the first `finished_count` components that are Active or in Error: is_new() of
    /// their inputs becomes false.
    void mark_inputs_read(const WindowRow& row, const ExecutionContext& context,
                          std::size_t finished_count) noexcept;
    /// Publishes the outputs of the window with its planned end, and adds them to the trace hash if the table
    /// requests it.
    void publish_outputs(const WindowRow& row, ModeMask held, Instant end) noexcept;
    /// Discards what the components of the window, or one component, wrote and did not publish.
    void discard_outputs(std::size_t window) noexcept;
    void discard_outputs_of(std::size_t component) noexcept;

    /// Makes the window serve the connections that are active in `modes`. An input whose connection ends or
    /// begins has no value until a value arrives that was published in the new mode.
    void restart_inputs(WindowState& state, ModeMask modes) noexcept;

    /// Hash of every publication so far: port row, sequence, instant and value. Without trace_hash() in the
    /// table, the value of an empty TraceHash.
    std::uint64_t get_trace_hash() const noexcept { return trace_hash_.get_value(); }

  private:
    static bool is_held(const ConnectionRow& connection, ModeMask modes) noexcept {
        return (connection.idle_modes & modes) == 0U;
    }
    /// Adds what the window has published with `end` to the trace hash.
    void hash_outputs(const WindowRow& row, Instant end) noexcept;
    /// Gives queues and crossings what the outputs of the component have published with `end`.
    void deliver_outputs(const ComponentRow& owner, ModeMask held, Instant end) noexcept;
    void discard_ports(std::size_t first, std::size_t count) noexcept;
    void note_discarded(const PortRow& port) noexcept;
    /// Reports each output whose values were lost, at most once per major frame.
    void report_losses(std::size_t first, std::size_t count) noexcept;

    CoreState core_;
    TraceHash trace_hash_{};
};

}  // namespace mamori::detail

#endif  // MAMORI_KERNEL_DATA_FLOW_HPP
