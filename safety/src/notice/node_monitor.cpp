// SPDX-License-Identifier: Apache-2.0
// Both ends of the notice of a node, so that the proofs about the library (symbols, stack, controller's
// compiler) include what a user's program will contain. Nothing refers to this object.
#include "mamori/safety/notice/node_monitor.hpp"

#include <array>

#include "mamori/safety/notice/survival_notifier.hpp"

namespace mamori::safety {
namespace detail {

inline constexpr NoticeNode kExampleNode{1U, Duration{1}, 2U, std::array<const char*, 3U>{"a", "b", "c"}};
inline constexpr NoticeLimits kExampleNoticeLimits{};

}  // namespace detail

template class SurvivalNotifier<detail::kExampleNode>;
template class NodeMonitor<detail::kExampleNode, detail::kExampleNoticeLimits>;

}  // namespace mamori::safety
