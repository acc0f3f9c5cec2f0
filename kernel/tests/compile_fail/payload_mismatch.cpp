// SPDX-License-Identifier: Apache-2.0
// Broken: a connection joins ports of two payload types.
#include "parts.hpp"

#ifdef MAMORI_BREAK
[[maybe_unused]] constexpr auto kConnection = mamori::connect(g_producer.whole, g_consumer.in);
#else
[[maybe_unused]] constexpr auto kConnection = mamori::connect(g_producer.real, g_consumer.in);
#endif
