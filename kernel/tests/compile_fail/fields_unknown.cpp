// SPDX-License-Identifier: Apache-2.0
// Broken: a field list names a field that the type does not have.
#include "mamori/kernel/payload/fields.hpp"

struct Sample {
    double position;
    int sequence;
    double velocity;
};
#ifdef MAMORI_BREAK
MAMORI_FIELDS(Sample, position, sequence, velocty)
#else
MAMORI_FIELDS(Sample, position, sequence, velocity)
#endif
