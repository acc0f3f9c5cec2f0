// SPDX-License-Identifier: Apache-2.0
// Broken: a field list leaves the last field out.
#include "mamori/kernel/payload/fields.hpp"

struct Sample {
    double position;
    int sequence;
    double velocity;
};
#ifdef MAMORI_BREAK
MAMORI_FIELDS(Sample, position, sequence)
#else
MAMORI_FIELDS(Sample, position, sequence, velocity)
#endif
