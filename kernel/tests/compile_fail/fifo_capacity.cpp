// SPDX-License-Identifier: Apache-2.0
// Broken: the buffer has room for MAMORI_BREAK entries, where 1 to 254 can be; 254 compiles.
#include "mamori/kernel/dataflow/fifo_buffer.hpp"

#ifndef MAMORI_BREAK
#define MAMORI_BREAK 254
#endif
mamori::FifoBuffer<double, MAMORI_BREAK> g_buffer;
