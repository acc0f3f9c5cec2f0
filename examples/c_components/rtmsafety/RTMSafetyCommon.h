/* SPDX-License-Identifier: Apache-2.0 */
/* Replaces the header of RTMSafety with this name, which is not public: only what public component templates
 * need, with return codes of OMG RTC. Compile a component for RTMSafety with the header of the product. */
#ifndef RTMSAFETY_COMMON_H
#define RTMSAFETY_COMMON_H

typedef enum ReturnCode { RTC_OK = 0, RTC_ERROR = 1 } ReturnCode_t;

#define PUBLIC
#define IMPORT extern

#endif
