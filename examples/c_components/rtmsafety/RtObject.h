/* SPDX-License-Identifier: Apache-2.0 */
/* Replaces the header of RTMSafety with this name, which is not public. The names of the ten members are
 * known; their order and further members are not. */
#ifndef RT_OBJECT_H
#define RT_OBJECT_H

#include "RTMSafetyCommon.h"

typedef struct RtObject {
    ReturnCode_t (*onInitialize)(void);
    ReturnCode_t (*onFinalize)(void);
    ReturnCode_t (*onStartup)(void);
    ReturnCode_t (*onShutdown)(void);
    ReturnCode_t (*onActivated)(void);
    ReturnCode_t (*onDeactivated)(void);
    ReturnCode_t (*onAborting)(void);
    ReturnCode_t (*onError)(void);
    ReturnCode_t (*onReset)(void);
    ReturnCode_t (*onExecute)(void);
} RtObject_t;

#endif
