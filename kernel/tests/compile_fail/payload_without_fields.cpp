// SPDX-License-Identifier: Apache-2.0
// Broken: a port carries a type without a field list.
#include "parts.hpp"

struct Sample {
    double value;
};
#ifndef MAMORI_BREAK
MAMORI_FIELDS(Sample, value)
#endif
mamori::OutPort<Sample> g_port{"port"};
