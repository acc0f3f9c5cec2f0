// SPDX-License-Identifier: Apache-2.0
// Broken: a field list names two fields of different types in the wrong order.
#include "mamori/kernel/payload/fields.hpp"

struct Sample {
    double position;
    int sequence;
    double velocity;
};
#ifdef MAMORI_BREAK
MAMORI_FIELDS(Sample, sequence, position, velocity)
#else
MAMORI_FIELDS(Sample, position, sequence, velocity)
#endif
