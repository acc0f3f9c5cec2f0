// SPDX-License-Identifier: Apache-2.0
// Broken: the status of a refusable operation is dropped.
#include "parts.hpp"

void initialize();
void initialize() {
#ifdef MAMORI_BREAK
    g_producer.initialize();
#else
    static_cast<void>(g_producer.initialize());
#endif
}
