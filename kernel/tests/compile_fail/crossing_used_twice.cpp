// SPDX-License-Identifier: Apache-2.0
// Broken: two connections go through one Crossing.
#include "parts.hpp"

inline Consumer g_second_consumer;
inline mamori::Crossing<double> g_second_crossing;
#ifdef MAMORI_BREAK
constexpr mamori::Crossing<double>& kSecondCrossing = g_crossing;
#else
constexpr mamori::Crossing<double>& kSecondCrossing = g_second_crossing;
#endif
constexpr auto kSystem =
    mamori::system(mamori::frame(1_ms),
                   mamori::window("sense", 0_us, 100_us, mamori::budget(50_us), mamori::run(g_producer)),
                   mamori::window("plan", 100_us, 100_us, mamori::core(1), mamori::budget(50_us),
                                  mamori::run(g_consumer, g_second_consumer)),
                   mamori::connect(g_producer.real, g_consumer.in, mamori::through(g_crossing)),
                   mamori::connect(g_producer.real, g_second_consumer.in, mamori::through(kSecondCrossing)));
MAMORI_CHECK(kSystem);
