// SPDX-License-Identifier: Apache-2.0
/// @file
/// LCM names of the time-stamped basic types of RT-middleware. Name your own sequences and strings, as in
/// `MAMORI_LCM_NAMES(ns::Joints, tm, data)` for `using Joints = mamori::rtc::TimedDoubleSeq<7U>`.
///
/// @satisfies SWR-LCM-001      Design: docs/design/lcm.md#types
#ifndef MAMORI_PORTS_LCM_RTC_NAMES_HPP
#define MAMORI_PORTS_LCM_RTC_NAMES_HPP

#include "mamori/kernel/payload/timed_types.hpp"
#include "mamori/ports/lcm/type_names.hpp"

MAMORI_LCM_NAMES(mamori::rtc::Time, sec, nsec)
MAMORI_LCM_NAMES(mamori::rtc::TimedState, tm, data)
MAMORI_LCM_NAMES(mamori::rtc::TimedShort, tm, data)
MAMORI_LCM_NAMES(mamori::rtc::TimedUShort, tm, data)
MAMORI_LCM_NAMES(mamori::rtc::TimedLong, tm, data)
MAMORI_LCM_NAMES(mamori::rtc::TimedULong, tm, data)
MAMORI_LCM_NAMES(mamori::rtc::TimedFloat, tm, data)
MAMORI_LCM_NAMES(mamori::rtc::TimedDouble, tm, data)
MAMORI_LCM_NAMES(mamori::rtc::TimedChar, tm, data)
MAMORI_LCM_NAMES(mamori::rtc::TimedOctet, tm, data)
MAMORI_LCM_NAMES(mamori::rtc::TimedBoolean, tm, data)

#endif  // MAMORI_PORTS_LCM_RTC_NAMES_HPP
