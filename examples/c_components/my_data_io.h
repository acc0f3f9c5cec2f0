/* SPDX-License-Identifier: Apache-2.0 */
/* MyDataIO: two components in C that exchange a type of their own, with structs, text and an enumeration. */
#ifndef MY_DATA_IO_H
#define MY_DATA_IO_H

#include "mamori/kernel/c/component.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct Tool {
    char name[8]; /* ends with a zero */
    double mass_kg;
    bool is_closed;
} Tool;

/* Which arms are in use: a number, because the size of an enumeration is the choice of the compiler. */
#define ARM_LEFT 0U
#define ARM_BOTH 2U

typedef struct MyData {
    uint8_t arm; /* ARM_LEFT, 1 for the right arm, ARM_BOTH */
    Tool tools[2];
} MyData;

typedef struct MyDataOut {
    MAMORI_OUT_PORT(MyData) data;
    uint8_t arm;
} MyDataOut;

typedef struct MyDataIn {
    MAMORI_IN_PORT(MyData) data;
    double mass_kg; /* of the tools in use */
} MyDataIn;

extern const MamoriActions my_data_out_actions;
extern const MamoriActions my_data_in_actions;

#ifdef __cplusplus
}
#endif

#endif
