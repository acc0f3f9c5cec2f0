/* SPDX-License-Identifier: Apache-2.0 */
/* MyDataOut sends the tools of both arms, and MyDataIn calculates the mass of those in use. After three
 * cycles, MyDataOut sends an invalid arm: MyDataIn fails and remains in Error. */
#include "my_data_io.h"

static MamoriStatus send(void* self, MamoriContext context) {
    MyDataOut* const own = self;
    const MyData data = {own->arm, {{"gripper", 0.75, true}, {"hook", 0.25, false}}};
    (void)context;
    MAMORI_WRITE(own->data, &data);
    own->arm = (uint8_t)((own->arm + 1U) % (ARM_BOTH + 2U));
    return MAMORI_RTC_OK;
}

static MamoriStatus calculate(void* self, MamoriContext context) {
    MyDataIn* const own = self;
    const MyData* const data = MAMORI_READ(own->data);
    (void)context;
    if (data->arm > ARM_BOTH) {
        return MAMORI_BAD_PARAMETER;
    }
    own->mass_kg = 0.0;
    for (uint32_t i = 0U; i < 2U; ++i) {
        if (data->arm == ARM_BOTH || data->arm == i) {
            own->mass_kg += data->tools[i].mass_kg;
        }
    }
    return MAMORI_RTC_OK;
}

static MamoriStatus forget(void* self, MamoriContext context) {
    MyDataIn* const own = self;
    (void)context;
    own->mass_kg = 0.0;
    return MAMORI_RTC_OK;
}

const MamoriActions my_data_out_actions = {.on_execute = send};
const MamoriActions my_data_in_actions = {.on_aborting = forget, .on_execute = calculate};
