/* SPDX-License-Identifier: Apache-2.0 */
/* Replaces the header of RTMSafety with this name, which is not public: how a callback accesses ports is not
 * known. Here, it uses the ports of Mamori's C interface. */
#ifndef DATA_PORT_H
#define DATA_PORT_H

#include "mamori/kernel/c/component.h"

#endif
