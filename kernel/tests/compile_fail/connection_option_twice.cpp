// SPDX-License-Identifier: Apache-2.0
// Broken: the second age limit would silently replace the first.
#include "parts.hpp"

#ifdef MAMORI_BREAK
constexpr auto kConnection =
    mamori::connect(g_producer.real, g_consumer.in, mamori::fresh_within(1_ms), mamori::fresh_within(2_ms));
#else
constexpr auto kConnection = mamori::connect(g_producer.real, g_consumer.in, mamori::fresh_within(1_ms));
#endif
constexpr auto kSystem = mamori::system(
    mamori::frame(1_ms),
    mamori::window("a", 0_us, 100_us, mamori::budget(50_us), mamori::run(g_producer, g_consumer)),
    kConnection);
MAMORI_CHECK(kSystem);
