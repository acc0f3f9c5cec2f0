// SPDX-License-Identifier: Apache-2.0
// Compiled by notice_compile_test.cpp with one defect at a time; without a defect it compiles.
#include "mamori/safety/notice/node_monitor.hpp"
#include "mamori/safety/notice/survival_notifier.hpp"

namespace {

using namespace mamori::literals;
using mamori::safety::NoticeLimits;
using mamori::safety::NoticeNode;
template <std::size_t kCount>
using Names = std::array<const char*, kCount>;

#if defined(MAMORI_DEFECT_NO_FRAME)
constexpr NoticeNode kNode{1U, 0_ms, 10U, Names<2U>{"reader", "guard"}};
#elif defined(MAMORI_DEFECT_NO_PERIOD)
constexpr NoticeNode kNode{1U, 1_ms, 0U, Names<2U>{"reader", "guard"}};
#elif defined(MAMORI_DEFECT_LONG_PERIOD)
constexpr NoticeNode kNode{1U, 3600_s, 0xFFFFFFFFU, Names<2U>{"reader", "guard"}};
#elif defined(MAMORI_DEFECT_NAME)
constexpr NoticeNode kNode{1U, 1_ms, 10U, Names<2U>{"reader", ""}};
#elif defined(MAMORI_DEFECT_NO_NAME)
constexpr NoticeNode kNode{1U, 1_ms, 10U, Names<2U>{"reader"}};
#elif defined(MAMORI_DEFECT_TOO_MANY)
constexpr NoticeNode<257U> kNode{1U, 1_ms, 10U, {"reader"}};
#elif defined(MAMORI_DEFECT_NO_COMPONENT)
constexpr NoticeNode<0U> kNode{1U, 1_ms, 10U, {}};
#else
constexpr NoticeNode kNode{1U, 1_ms, 10U, Names<2U>{"reader", "guard"}};
#endif

#if defined(MAMORI_DEFECT_LIMITS)
constexpr NoticeLimits kLimits{1_ms, 3U, 3U, 10U};
#elif defined(MAMORI_DEFECT_START)
constexpr NoticeLimits kLimits{1_ms, 2U, 3U, 2U};
#else
constexpr NoticeLimits kLimits{1_ms, 2U, 3U, 10U};
#endif

mamori::safety::NodeMonitor<kNode, kLimits> monitor{"monitor"};

}  // namespace
