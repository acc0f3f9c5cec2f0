// SPDX-License-Identifier: Apache-2.0
// Broken: a connection leaves its partition with nothing in between.
#include "parts.hpp"

#ifdef MAMORI_BREAK
constexpr const char* kPartition = "other";
#else
constexpr const char* kPartition = "safety";
#endif
constexpr auto kSystem = mamori::system(mamori::frame(1_ms),
                                        mamori::window("sense", 0_us, 100_us, mamori::partition("safety"),
                                                       mamori::budget(50_us), mamori::run(g_producer)),
                                        mamori::window("plan", 100_us, 100_us, mamori::partition(kPartition),
                                                       mamori::budget(50_us), mamori::run(g_consumer)),
                                        mamori::connect(g_producer.real, g_consumer.in));
MAMORI_CHECK(kSystem);
