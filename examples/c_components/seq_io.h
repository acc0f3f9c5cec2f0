/* SPDX-License-Identifier: Apache-2.0 */
/* SeqIO: two components in C that exchange sequences of up to SEQUENCE_CAPACITY values. */
#ifndef SEQ_IO_H
#define SEQ_IO_H

#include "mamori/kernel/c/component.h"

#ifdef __cplusplus
extern "C" {
#endif

#define SEQUENCE_CAPACITY 8U

typedef struct Samples {
    uint32_t length;
    int16_t counts[SEQUENCE_CAPACITY]; /* elements from `length` on are 0 */
    double angles_rad[SEQUENCE_CAPACITY];
} Samples;

typedef struct SeqOut {
    MAMORI_OUT_PORT(Samples) samples;
    int16_t count;
} SeqOut;

typedef struct SeqIn {
    MAMORI_IN_PORT(Samples) samples;
    int32_t count_sum;
    double angle_max_rad;
} SeqIn;

extern const MamoriActions seq_out_actions;
extern const MamoriActions seq_in_actions;

#ifdef __cplusplus
}
#endif

#endif
