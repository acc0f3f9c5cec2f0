// SPDX-License-Identifier: Apache-2.0
/// @file
/// All of end-to-end protection: both ends of a channel, all profiles, both orders, the state of a channel,
/// its budget, and the ports of a component.
///
/// @satisfies SWR-E2E-003      Design: docs/design/e2e.md#end-to-end-protection
#ifndef MAMORI_SAFETY_E2E_E2E_HPP
#define MAMORI_SAFETY_E2E_E2E_HPP

#include "mamori/safety/e2e/channel_budget.hpp"
#include "mamori/safety/e2e/checker.hpp"
#include "mamori/safety/e2e/in_port.hpp"
#include "mamori/safety/e2e/out_port.hpp"
#include "mamori/safety/e2e/profile_01.hpp"
#include "mamori/safety/e2e/profile_02.hpp"
#include "mamori/safety/e2e/profile_04.hpp"
#include "mamori/safety/e2e/profile_05.hpp"
#include "mamori/safety/e2e/protected_link.hpp"
#include "mamori/safety/e2e/protector.hpp"
#include "mamori/safety/e2e/state_machine.hpp"

#endif  // MAMORI_SAFETY_E2E_E2E_HPP
