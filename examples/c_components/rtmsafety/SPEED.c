/* SPDX-License-Identifier: Apache-2.0 */
#include "SPEED.h"

#include <stddef.h>

#define SPEED_MAX_RAD_S 6.0
#define STANDSTILL_RAD_S 0.1

static ReturnCode_t SPEED_on_initialize(void) {
    return RTC_OK;
}

/* A speed above the limit in either direction, or no new value, is an error, which ends the component: its
 * supervision demands the stop. Only a new value confirms standstill. */
static ReturnCode_t SPEED_on_execute(void) {
    const bool is_new = MAMORI_IS_NEW(speed_ports.speed_rad_s);
    const double value_rad_s = *MAMORI_READ(speed_ports.speed_rad_s);
    const double speed_rad_s = value_rad_s < 0.0 ? -value_rad_s : value_rad_s;
    const bool is_standing = is_new && speed_rad_s < STANDSTILL_RAD_S;
    MAMORI_WRITE(speed_ports.is_standing, &is_standing);
    return is_new && speed_rad_s <= SPEED_MAX_RAD_S ? RTC_OK : RTC_ERROR;
}

ReturnCode_t SPEED_create(SPEED_t* pself) {
    if (pself == NULL) {
        return RTC_ERROR;
    }
    pself->onInitialize = SPEED_on_initialize;
    pself->onExecute = SPEED_on_execute;
    return RTC_OK;
}
