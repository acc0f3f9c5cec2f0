// SPDX-License-Identifier: Apache-2.0
// Broken: a connection feeds a component that no window runs.
#include "parts.hpp"

constexpr auto kSystem =
    mamori::system(mamori::frame(1_ms),
#ifdef MAMORI_BREAK
                   mamori::window("a", 0_us, 100_us, mamori::budget(50_us), mamori::run(g_producer)),
#else
                   mamori::window("a", 0_us, 100_us, mamori::budget(50_us),
                                  mamori::run(g_producer, g_consumer)),
#endif
                   mamori::connect(g_producer.real, g_consumer.in));
MAMORI_CHECK(kSystem);
