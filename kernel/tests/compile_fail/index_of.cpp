// SPDX-License-Identifier: Apache-2.0
// What the compiler rejects: an index of what is not in the table.
// Each namespace compiles, and does not with its MAMORI_BREAK_<NAME>.
#include "parts.hpp"

constexpr auto kSystem = mamori::system(
    mamori::frame(1_ms), mamori::window("a", 0_us, 100_us, mamori::budget(50_us), mamori::run(g_producer)),
    mamori::window("b", 100_us, 100_us, mamori::budget(50_us), mamori::run(g_second_producer)));
MAMORI_CHECK(kSystem);

namespace component_of_no_window {
#ifdef MAMORI_BREAK_COMPONENT_OF_NO_WINDOW
constexpr const mamori::Component& kAsked = g_consumer;
#else
constexpr const mamori::Component& kAsked = g_second_producer;
#endif
static_assert(mamori::index_of(kSystem, kAsked) == 1U);
}  // namespace component_of_no_window

namespace array_bound {
#ifdef MAMORI_BREAK_ARRAY_BOUND
constexpr const char* kAsked = "c";
#else
constexpr const char* kAsked = "b";
#endif
using UpTo = std::array<int, mamori::index_of(kSystem, kAsked) + 1U>;
static_assert(std::tuple_size_v<UpTo> == 2U);
}  // namespace array_bound
