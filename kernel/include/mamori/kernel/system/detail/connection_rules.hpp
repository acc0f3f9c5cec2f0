// SPDX-License-Identifier: Apache-2.0
/// @file
/// What MAMORI_CHECK says of a component, a connection, a fault or a reaction that breaks a rule. Not for
/// users.
///
/// @satisfies SWR-KRN-018      Design: docs/design/kernel.md#system-table
#ifndef MAMORI_KERNEL_CONNECTION_RULES_HPP
#define MAMORI_KERNEL_CONNECTION_RULES_HPP

#include <cstddef>

#include "mamori/kernel/system/detail/table_rule.hpp"

namespace mamori {

namespace rules {

// The last argument of a component or port tells instances of one type apart: 0 is the first in the table.

template <typename C, std::size_t kInstance>
struct ComponentRunsInOneContext {
    static_assert(kKept<C>, "a component runs in one window, once");
};
template <typename Connection>
struct ConnectionJoinsComponentsOfTheTable {
    static_assert(kKept<Connection>, "both ends of a connection belong to components that a window runs");
};
template <typename C, auto kPort, std::size_t kInstance>
struct InputIsConnected {
    static_assert(kKept<C>, "a mandatory input is connected");
};
template <typename C, auto kPort, std::size_t kInstance>
struct InputHasOneWriter {
    static_assert(kKept<C>, "an input has one writer");
};
template <typename C, auto kPort, std::size_t kInstance>
struct InputCanBeFresh {
    static_assert(kKept<C>, "the age up to which a value is fresh is positive: fresh_within(...)");
};
template <typename C, auto kPort, std::size_t kInstance>
struct InputFromElsewhereHasACrossing {
    static_assert(kKept<C>,
                  "a connection between cores or partitions goes through(...) a Crossing, or to a queue");
};
template <typename C, auto kPort, std::size_t kInstance>
struct InputHasACrossingOfItsOwn {
    static_assert(kKept<C>, "a Crossing serves one connection");
};
template <typename C, auto kPort, std::size_t kInstance>
struct ReaderNeverOpensWhileItsWriterIsOpen {
    static_assert(kKept<C>,
                  "a latest value crosses cores between the close of its writer and its next opening");
};
template <auto kFault>
struct FaultIsDeclaredOnce {
    static_assert(kKept<decltype(kFault)>, "a fault is declared once");
};
template <auto kFault>
struct FaultHasReaction {
    static_assert(kKept<decltype(kFault)>,
                  "a declared fault has exactly one reaction: add react(fault, ...)");
};
template <typename Reaction>
struct ReactionAnswersADeclaredFault {
    static_assert(kKept<Reaction>, "a reaction answers a declared fault, in a positive time");
};

}  // namespace rules

}  // namespace mamori

#endif  // MAMORI_KERNEL_CONNECTION_RULES_HPP
