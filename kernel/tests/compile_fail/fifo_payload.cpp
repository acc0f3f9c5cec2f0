// SPDX-License-Identifier: Apache-2.0
// Broken: the buffer carries a payload that needs a copy constructor.
#include "mamori/kernel/dataflow/fifo_buffer.hpp"

struct Payload {
#ifdef MAMORI_BREAK
    Payload() = default;
    Payload(const Payload& other) : value(other.value) {}
#endif
    double value{0.0};
};
mamori::FifoBuffer<Payload, 4U> g_buffer;
