// SPDX-License-Identifier: Apache-2.0
// Broken: a window that opens every 0 ms.
#include "parts.hpp"

#ifdef MAMORI_BREAK
constexpr mamori::Duration kPeriod{0};
#else
constexpr mamori::Duration kPeriod{1000000};
#endif
constexpr auto kSystem =
    mamori::system(mamori::frame(1_ms), mamori::window("a", 0_us, 100_us, mamori::every(kPeriod),
                                                       mamori::budget(50_us), mamori::run(g_producer)));
MAMORI_CHECK(kSystem);
