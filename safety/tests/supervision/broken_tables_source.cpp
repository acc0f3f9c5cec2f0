// SPDX-License-Identifier: Apache-2.0
// Compiled by supervision_compile_test.cpp with a group of broken tables at a time, few enough for a compiler
// to report all; without a group it compiles.
#include "broken_tables.hpp"

namespace mamori::safety {
namespace {

static_assert(is_sound<broken::kSound>());

#ifdef MAMORI_DEFECT_ENTITIES
static_assert(is_sound<broken::kTableEmpty>());
static_assert(is_sound<broken::kNoMode>());
static_assert(is_sound<broken::kEntityTwice>());
static_assert(is_sound<broken::kEntityOutOfOrder>());
static_assert(is_sound<broken::kEntityInNoMode>());
static_assert(is_sound<broken::kEntityUnsupervised>());
static_assert(is_sound<broken::kModeUnsupervised>());
#endif
#ifdef MAMORI_DEFECT_ROWS
static_assert(is_sound<broken::kCheckpointTwice>());
static_assert(is_sound<broken::kCheckpointOutOfOrder>());
static_assert(is_sound<broken::kCheckpointOfUnknownEntity>());
static_assert(is_sound<broken::kCheckpointUnused>());
static_assert(is_sound<broken::kAliveOfUnknown>());
static_assert(is_sound<broken::kAliveTwice>());
#endif
#ifdef MAMORI_DEFECT_DEADLINES
static_assert(is_sound<broken::kDeadlineFromUnknown>());
static_assert(is_sound<broken::kDeadlineToItself>());
static_assert(is_sound<broken::kDeadlineBetween>());
static_assert(is_sound<broken::kDeadlineTwice>());
#endif
#ifdef MAMORI_DEFECT_LIMITS
static_assert(is_sound<broken::kAliveNothing>());
static_assert(is_sound<broken::kAliveMargin>());
static_assert(is_sound<broken::kAliveBeyondQueue>());
static_assert(is_sound<broken::kDeadlineLimits>());
#endif
#ifdef MAMORI_DEFECT_GRAPH
static_assert(is_sound<broken::kEdgeFromUnknown>());
static_assert(is_sound<broken::kEdgeToUnordered>());
static_assert(is_sound<broken::kEdgeBetween>());
static_assert(is_sound<broken::kEdgeLeavesFinal>());
static_assert(is_sound<broken::kEdgeTwice>());
static_assert(is_sound<broken::kGraphWithoutInitial>());
static_assert(is_sound<broken::kUnreachable>());
static_assert(is_sound<broken::kDeadEnd>());
static_assert(is_sound<broken::kFinishWithoutStart>());
#endif

}  // namespace
}  // namespace mamori::safety
