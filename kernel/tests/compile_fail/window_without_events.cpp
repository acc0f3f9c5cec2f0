// SPDX-License-Identifier: Apache-2.0
// Broken: a window that serves events, but none in any cycle.
#include "parts.hpp"

#ifdef MAMORI_BREAK
constexpr std::size_t kEvents = 0U;
#else
constexpr std::size_t kEvents = 1U;
#endif
constexpr auto kSystem =
    mamori::system(mamori::frame(1_ms), mamori::window("serve", 0_us, 100_us, mamori::event_driven(kEvents),
                                                       mamori::budget(50_us), mamori::run(g_producer)));
MAMORI_CHECK(kSystem);
