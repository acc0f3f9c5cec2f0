/* SPDX-License-Identifier: Apache-2.0 */
/* SeqOut sends sequences of 1, 2, ... SEQUENCE_CAPACITY elements, then of 1 again. SeqIn evaluates them. */
#include "seq_io.h"

static MamoriStatus send(void* self, MamoriContext context) {
    SeqOut* const own = self;
    Samples samples = {0};
    (void)context;
    samples.length = (uint32_t)own->count % SEQUENCE_CAPACITY + 1U;
    for (uint32_t i = 0U; i < samples.length; ++i) {
        samples.counts[i] = own->count;
        samples.angles_rad[i] = 0.5 * (double)i;
    }
    own->count = own->count < INT16_MAX ? (int16_t)(own->count + 1) : 0;
    MAMORI_WRITE(own->samples, &samples);
    return MAMORI_RTC_OK;
}

static MamoriStatus evaluate(void* self, MamoriContext context) {
    SeqIn* const own = self;
    const Samples* const samples = MAMORI_READ(own->samples);
    (void)context;
    if (samples->length > SEQUENCE_CAPACITY) {
        return MAMORI_BAD_PARAMETER;
    }
    own->count_sum = 0;
    own->angle_max_rad = 0.0;
    for (uint32_t i = 0U; i < samples->length; ++i) {
        own->count_sum += samples->counts[i];
        own->angle_max_rad =
            samples->angles_rad[i] > own->angle_max_rad ? samples->angles_rad[i] : own->angle_max_rad;
    }
    return MAMORI_RTC_OK;
}

const MamoriActions seq_out_actions = {.on_execute = send};
const MamoriActions seq_in_actions = {.on_execute = evaluate};
