// SPDX-License-Identifier: Apache-2.0
/// @file
/// Function connect(...): connects an output to an input.
///
/// @satisfies SWR-KRN-017      Design: docs/design/kernel.md#system-table
#ifndef MAMORI_KERNEL_CONNECTION_PART_HPP
#define MAMORI_KERNEL_CONNECTION_PART_HPP

#include <array>
#include <cstddef>
#include <type_traits>

#include "mamori/kernel/dataflow/connection.hpp"
#include "mamori/kernel/dataflow/data_port.hpp"
#include "mamori/kernel/system/connection_option.hpp"
#include "mamori/kernel/system/detail/option_words.hpp"
#include "mamori/kernel/system/detail/part_types.hpp"
#include "mamori/kernel/table/connection_row.hpp"

namespace mamori {

/// One connection of the description. @tparam kModeCount number of modes in its only_in().
template <std::size_t kModeCount>
struct ConnectionPart {
    struct Types : detail::NoTypes {
        static constexpr std::size_t kConnections = 1U;
        static constexpr std::size_t kConnectionModes = kModeCount;
    };
    ConnectionRow row{};
    std::array<const char*, kModeCount> modes{};
};

/// Connects `source` to `sink`, which must have the same payload type.
/// @param[in] source  OutPort or QueueOutPort; must outlive the table.
/// @param[in] sink    InPort or QueueInPort; must outlive the table.
/// @param[in] options fresh_within(...) or any_age(); through(...), only_in(...), delayed_by_a_frame(); each
///                    at most once.
template <typename Source, typename Sink, typename... Options>
constexpr ConnectionPart<(detail::kModesNamedBy<Options> + ... + 0U)> connect(Source& source, Sink& sink,
                                                                              Options... options) noexcept {
    constexpr bool kJoinsPorts =
        std::is_base_of_v<OutPortBase, Source> && std::is_base_of_v<InPortBase, Sink>;
    // Written out, so that the message names the wrong type.
    static_assert(std::is_base_of_v<OutPortBase, Source>, "connect() joins an output to an input");
    static_assert(std::is_base_of_v<InPortBase, Sink>, "connect() joins an output to an input");
    static_assert(detail::kIsEachSaidOnce<Options...>, "each option of a connection is said once");
    static_assert(detail::kTimesSaid<FreshWithin, Options...> + detail::kTimesSaid<AnyAge, Options...> <= 1U,
                  "a connection states fresh_within(...) or any_age(), not both");
    ConnectionPart<(detail::kModesNamedBy<Options> + ... + 0U)> part{};
    if constexpr (kJoinsPorts) {
        using T = typename Source::Payload;
        static_assert(std::is_same_v<T, typename Sink::Payload>, "connect() joins ports of one payload type");
        part.row.source = &source;
        part.row.sink = &sink;
        if constexpr (std::is_same_v<T, typename Sink::Payload>) {
            using Connection = std::conditional_t<Sink::kIsQueue, detail::QueueConnection<Source, Sink>,
                                                  detail::LatestConnection<T, Sink>>;
            part.row.operations = Connection::kOperations;
            (detail::apply<T, Sink>(part, options), ...);
        }
    }
    return part;
}

}  // namespace mamori

#endif  // MAMORI_KERNEL_CONNECTION_PART_HPP
