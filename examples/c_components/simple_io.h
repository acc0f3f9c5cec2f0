/* SPDX-License-Identifier: Apache-2.0 */
/* SimpleIO: a component in C with an input and an output of numbers. */
#ifndef SIMPLE_IO_H
#define SIMPLE_IO_H

#include "mamori/kernel/c/component.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A number with the instant at which it was read, as TimedLong of OpenRTM. */
typedef struct Number {
    uint32_t sec;
    uint32_t nsec;
    int32_t data;
} Number;

/* Ports first, in the order of their initial values; then the data of the component. */
typedef struct SimpleIo {
    MAMORI_IN_PORT(Number) in;
    MAMORI_OUT_PORT(Number) out;
    int32_t sum;
} SimpleIo;

extern const MamoriActions simple_io_actions;

#ifdef __cplusplus
}
#endif

#endif
