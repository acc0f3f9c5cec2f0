// SPDX-License-Identifier: Apache-2.0
/// @file
/// The 25 headers that a user of the kernel needs, in one include. docs/manual/headers.md lists each with its
/// purpose. Code that is compiled often includes the single headers.
#ifndef MAMORI_KERNEL_HPP
#define MAMORI_KERNEL_HPP

#include "mamori/kernel/base/assert.hpp"
#include "mamori/kernel/base/status.hpp"
#include "mamori/kernel/base/time.hpp"
#include "mamori/kernel/component/component.hpp"
#include "mamori/kernel/component/execution_context.hpp"
#include "mamori/kernel/component/external_trigger.hpp"
#include "mamori/kernel/component/fsm_check.hpp"
#include "mamori/kernel/component/fsm_component.hpp"
#include "mamori/kernel/component/multi_mode.hpp"
#include "mamori/kernel/dataflow/data_port.hpp"
#include "mamori/kernel/dataflow/queue_in_port.hpp"
#include "mamori/kernel/dataflow/queue_out_port.hpp"
#include "mamori/kernel/parameter/configuration_set.hpp"
#include "mamori/kernel/parameter/parameter.hpp"
#include "mamori/kernel/payload/bounded_sequence.hpp"
#include "mamori/kernel/payload/bounded_string.hpp"
#include "mamori/kernel/payload/cdr.hpp"
#include "mamori/kernel/payload/fields.hpp"
#include "mamori/kernel/payload/timed_types.hpp"
#include "mamori/kernel/record/event_log.hpp"
#include "mamori/kernel/record/flight_recorder.hpp"
#include "mamori/kernel/run/executive.hpp"
#include "mamori/kernel/run/introspection.hpp"
#include "mamori/kernel/run/system_modes.hpp"
#include "mamori/kernel/system/system.hpp"

#endif  // MAMORI_KERNEL_HPP
