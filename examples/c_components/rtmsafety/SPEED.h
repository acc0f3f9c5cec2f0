/* SPDX-License-Identifier: Apache-2.0 */
/* A component with the C interface of RTMSafety: checks the speed of a wheel. */
#ifndef SPEED_H
#define SPEED_H

#include "DataPort.h"
#include "RTMSafetyCommon.h"
#include "RtObject.h"

typedef RtObject_t SPEED_t;

PUBLIC ReturnCode_t SPEED_create(SPEED_t* pself);

/* A callback receives no argument, so the ports are global. C++ defines them. */
typedef struct SpeedPorts {
    MAMORI_IN_PORT(double) speed_rad_s;
    MAMORI_OUT_PORT(bool) is_standing;
} SpeedPorts;
IMPORT const SpeedPorts speed_ports;

#endif
