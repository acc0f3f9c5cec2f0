/* SPDX-License-Identifier: Apache-2.0 */
/** @file
 * C99 interface of RT components: the actions of a component as function pointers, and typed data ports.
 * mamori/kernel/c/c_component.hpp runs such a component in a system table and connects its ports.
 *
 * @satisfies SWR-CIF-001, SWR-CIF-003      Design: docs/design/kernel.md#components-in-c
 * Source:   OMG RTC 1.0, ReturnCode_t, ComponentAction; OpenRTM PortStatus
 */
#ifndef MAMORI_KERNEL_C_COMPONENT_H
#define MAMORI_KERNEL_C_COMPONENT_H

#include <stdbool.h>
#include <stdint.h>

/** Return code of an action: one of the next six numbers. Any other number counts as MAMORI_RTC_ERROR. */
typedef uint32_t MamoriStatus;
#define MAMORI_RTC_OK 0U
#define MAMORI_RTC_ERROR 1U
#define MAMORI_BAD_PARAMETER 2U
#define MAMORI_UNSUPPORTED 3U
#define MAMORI_OUT_OF_RESOURCES 4U
#define MAMORI_PRECONDITION_NOT_MET 5U

/** Status of the value of an input: one of the next three numbers. */
typedef uint32_t MamoriPortStatus;
#define MAMORI_PORT_OK 0U
#define MAMORI_BUFFER_EMPTY 3U   /**< no value */
#define MAMORI_BUFFER_TIMEOUT 4U /**< older than the connection permits, or from the future */

/** The context that calls an action: mamori::ContextHandle. */
typedef struct MamoriContext {
    int32_t id;     /**< index of the window in the system table; -1: no context */
    int64_t now_ns; /**< planned start of the window that runs the action [ns] */
} MamoriContext;

/** Each action receives `self`, the struct of its component. */
typedef MamoriStatus (*MamoriLifeAction)(void* self);
typedef MamoriStatus (*MamoriAction)(void* self, MamoriContext context);

/** Actions of a component. A null pointer is an action that returns MAMORI_RTC_OK. mamori::Component states
 * when each is called and the effect of its return code. An action returns within the budget of its window
 * and calls no function that blocks. */
typedef struct MamoriActions {
    MamoriLifeAction on_initialize;
    MamoriLifeAction on_finalize;
    MamoriAction on_startup;
    MamoriAction on_shutdown;
    MamoriAction on_activated;
    MamoriAction on_deactivated;
    MamoriAction on_aborting;
    MamoriAction on_error;
    MamoriAction on_reset;
    MamoriAction on_execute;
    MamoriAction on_state_update;
    MamoriAction on_rate_changed;
} MamoriActions;

/** An input as member of the struct of a component: `MAMORI_IN_PORT(double) speed;`. C++ initialises it with
 * mamori::c_port(), which rejects another payload type. In C, a value of another type is only a warning:
 * compile with -Werror=incompatible-pointer-types -Werror=pointer-sign. No compiler checks a `void*`. For
 * actions only; each macro evaluates its port expression twice. */
#define MAMORI_IN_PORT(Type)                                                      \
    struct {                                                                      \
        const void* port;                                                         \
        const Type* (*read)(const void* port);                                    \
        bool (*is_new)(const void* port);                                         \
        MamoriPortStatus (*calc_status)(const void* port, MamoriContext context); \
    }
/** Never null. Before the first value, it points to a zero-initialised value: check MAMORI_CALC_STATUS. The
 * value does not change during an action. */
#define MAMORI_READ(input) ((input).read((input).port))
/** True when the value arrived after the last completed cycle of the component. */
#define MAMORI_IS_NEW(input) ((input).is_new((input).port))
/** Status of the value in the cycle of `context`. */
#define MAMORI_CALC_STATUS(input, context) ((input).calc_status((input).port, (context)))

/** An output as member of the struct of a component. */
#define MAMORI_OUT_PORT(Type)                         \
    struct {                                          \
        void* port;                                   \
        void (*write)(void* port, const Type* value); \
    }
/** Copies `*value`, which is published at window end; `value` must not be null. A second write in one cycle
 * replaces the first. */
#define MAMORI_WRITE(output, value) ((output).write((output).port, (value)))

#endif /* MAMORI_KERNEL_C_COMPONENT_H */
