// SPDX-License-Identifier: Apache-2.0
/// @file
/// Rows of a system table for the data flow: ports and their connections.
///
/// @satisfies SWR-KRN-017      Design: docs/design/kernel.md#system-table
#ifndef MAMORI_KERNEL_CONNECTION_ROW_HPP
#define MAMORI_KERNEL_CONNECTION_ROW_HPP

#include <cstddef>
#include <cstdint>

#include "mamori/kernel/base/time.hpp"
#include "mamori/kernel/component/component.hpp"
#include "mamori/kernel/dataflow/connection.hpp"
#include "mamori/kernel/dataflow/data_port.hpp"
#include "mamori/kernel/payload/trace_hash.hpp"
#include "mamori/kernel/table/mode_mask.hpp"
#include "mamori/kernel/table/table_index.hpp"

namespace mamori {

/// One port of a component; exactly one of `input` and `output` is set. What it refers to must outlive the
/// table.
struct PortRow {
    Component* owner{nullptr};
    InPortBase* input{nullptr};
    OutPortBase* output{nullptr};
    bool is_mandatory{false};         ///< of an input; false for an output
    std::uint16_t payload_bytes{0U};  ///< size of one value; 0: 64 KiB or more. For tools.
    std::size_t window{kNoIndex};     ///< index of the window of its owner
    std::size_t component{kNoIndex};  ///< index of its owner in the table
    /// Returns the counters of an input.
    PortCounts (*count)(const InPortBase&) noexcept {&count_latest};
    /// Adds a publication of an output to the trace hash; nullptr: an input, or no trace_hash() requested.
    void (*hash_published)(const OutPortBase&, TraceHash&) noexcept {nullptr};
};

/// One connection from an output to an input. What it refers to must outlive the table.
struct ConnectionRow : ConnectionEnds, AgeLimits {
    ConnectionOperations operations{};
    /// Indices of the ends in the table; kNoIndex: the port belongs to no component of the table.
    std::size_t source_window{kNoIndex};
    std::size_t sink_window{kNoIndex};
    std::size_t source_component{kNoIndex};
    std::size_t sink_component{kNoIndex};
    /// Source and sink run in one window, the source first: the value is forwarded within the window.
    bool is_forward_in_window{false};
    bool is_delayed_by_a_frame{false};  ///< as its options state
    /// Modes in which it is inactive: only_in() excludes them, or one of its components does not run.
    ModeMask idle_modes{0U};

    /// In which it is active.
    constexpr ModeMask get_modes() const noexcept { return ~idle_modes; }
};

}  // namespace mamori

#endif  // MAMORI_KERNEL_CONNECTION_ROW_HPP
