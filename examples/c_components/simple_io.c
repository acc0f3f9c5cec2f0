/* SPDX-License-Identifier: Apache-2.0 */
/* Sends the sum of the numbers that it has received since its activation. A sum outside 32 bits is an error.
 */
#include "simple_io.h"

static MamoriStatus on_activated(void* self, MamoriContext context) {
    SimpleIo* const own = self;
    (void)context;
    own->sum = 0;
    return MAMORI_RTC_OK;
}

static MamoriStatus on_execute(void* self, MamoriContext context) {
    SimpleIo* const own = self;
    const Number* const in = MAMORI_READ(own->in);
    if (!MAMORI_IS_NEW(own->in) || MAMORI_CALC_STATUS(own->in, context) != MAMORI_PORT_OK) {
        return MAMORI_RTC_OK;
    }
    if ((in->data > 0 && own->sum > INT32_MAX - in->data) ||
        (in->data < 0 && own->sum < INT32_MIN - in->data)) {
        return MAMORI_OUT_OF_RESOURCES;
    }
    own->sum += in->data;
    {
        Number out = *in;
        out.data = own->sum;
        MAMORI_WRITE(own->out, &out);
    }
    return MAMORI_RTC_OK;
}

const MamoriActions simple_io_actions = {.on_activated = on_activated, .on_execute = on_execute};
