// SPDX-License-Identifier: Apache-2.0
// Broken: no value is younger than zero.
#include "parts.hpp"

#ifdef MAMORI_BREAK
constexpr mamori::Duration kAgeMax{0};
#else
constexpr mamori::Duration kAgeMax{1};
#endif
constexpr auto kSystem = mamori::system(
    mamori::frame(1_ms),
    mamori::window("a", 0_us, 100_us, mamori::budget(50_us), mamori::run(g_producer, g_consumer)),
    mamori::connect(g_producer.real, g_consumer.in, mamori::fresh_within(kAgeMax)));
MAMORI_CHECK(kSystem);
