// SPDX-License-Identifier: Apache-2.0
// Compiled by port_compile_test.cpp with one defect at a time; without a defect it compiles.
#include <cstdint>

#include "mamori/kernel/base/constant_init.hpp"
#include "mamori/kernel/dataflow/data_port.hpp"
#include "mamori/safety/e2e/e2e.hpp"

namespace defects {

using namespace mamori::safety;  // NOLINT: a table of their names
using namespace mamori::literals;

struct Speed {
    double rad_s{0.0};
    mamori::BoundedSequence<std::uint8_t, 4U> notes{};
};

}  // namespace defects

MAMORI_FIELDS(defects::Speed, rad_s, notes)

namespace defects {

// ---- Channels by themselves: one for each reason to refuse one. ----
#if defined(MAMORI_DEFECT_LENGTH)
constexpr SentIdChannel kChannel{7U, 11U, 24U};  // shorter than the header
static_assert(is_sound<E2eProfile04<>, kChannel>());
#elif defined(MAMORI_DEFECT_LENGTH_GREATEST)
constexpr SentIdChannel kChannel{7U, 24U, 4097U};
static_assert(is_sound<E2eProfile04<>, kChannel>());
#elif defined(MAMORI_DEFECT_OFFSET)
constexpr SentIdChannel kChannel{7U, 24U, 24U, 13U};  // header ends behind the shortest frame
static_assert(is_sound<E2eProfile04<>, kChannel>());
#elif defined(MAMORI_DEFECT_OFFSET_OVERLAP)
constexpr NibbleCounterChannel kChannel{0x0123U, DataIdMode::kBoth, 14U, 8U, 8U};  // counter in the checksum
static_assert(is_sound<E2eProfile01<>, kChannel>());
#elif defined(MAMORI_DEFECT_DATA_ID)
constexpr NibbleCounterChannel kChannel{0x0123U, DataIdMode::kLow, 14U};  // of more than its low byte
static_assert(is_sound<E2eProfile01<>, kChannel>());
#elif defined(MAMORI_DEFECT_STUCK)
constexpr NibbleCounterChannel kChannel{0x0000U, DataIdMode::kLow, 14U};  // checksum of zeros is zero
static_assert(is_sound<E2eProfile01<>, kChannel>());
#elif defined(MAMORI_DEFECT_LIMITS_PLAIN)
constexpr PlainLimits kLimits{0U};
static_assert(are_sound<E2eProfile04<>, PlainSequence, kLimits>());
#elif defined(MAMORI_DEFECT_LIMITS_SYNCHRONISING)
constexpr SynchronisingLimits kLimits{15U};
static_assert(are_sound<E2eProfile01<>, SynchronisingSequence, kLimits>());
#elif defined(MAMORI_DEFECT_LIMITS_HARDENED)
constexpr HardenedLimits kLimits{8U};  // beyond half the counter
static_assert(are_sound<E2eProfile01<>, HardenedSequence, kLimits>());
#else
constexpr SentIdChannel kChannel{7U, 24U, 24U};
constexpr PlainLimits kLimits{1U};
static_assert(is_sound<E2eProfile04<>, kChannel>() && are_sound<E2eProfile04<>, PlainSequence, kLimits>());
#endif

// ---- Messages: channel and payload together. ----
#if defined(MAMORI_DEFECT_MESSAGE_CHANNEL)
constexpr SentIdChannel kSpeedChannel{7U, 24U, 28U, 13U};
using SafeSpeed = E2eMessage<Speed, E2eProfile04<>, kSpeedChannel>;
#elif defined(MAMORI_DEFECT_MESSAGE_SHORTEST)
constexpr SentIdChannel kSpeedChannel{7U, 23U, 28U};
using SafeSpeed = E2eMessage<Speed, E2eProfile04<>, kSpeedChannel>;
#elif defined(MAMORI_DEFECT_MESSAGE_LONGEST)
constexpr SentIdChannel kSpeedChannel{7U, 24U, 29U};
using SafeSpeed = E2eMessage<Speed, E2eProfile04<>, kSpeedChannel>;
#elif defined(MAMORI_DEFECT_MESSAGE_WITHOUT_LENGTH_FIELD)
constexpr KnownIdChannel kSpeedChannel{7U, 19U, 19U};
using SafeSpeed = E2eMessage<Speed, E2eProfile05<>, kSpeedChannel>;
#elif defined(MAMORI_DEFECT_MESSAGE_PAYLOAD)
struct Unlisted {
    double rad_s{0.0};
};
constexpr SentIdChannel kSpeedChannel{7U, 20U, 20U};
using SafeSpeed = E2eMessage<Unlisted, E2eProfile04<>, kSpeedChannel>;
#else
constexpr SentIdChannel kSpeedChannel{7U, 24U, 28U};
using SafeSpeed = E2eMessage<Speed, E2eProfile04<>, kSpeedChannel>;
#endif

// ---- Ports. ----
constexpr E2eInLimits<PlainSequence> kPortLimits{
#if defined(MAMORI_DEFECT_PORT_AGE)
    0_ms,
#else
    30_ms,
#endif
#if defined(MAMORI_DEFECT_PORT_ORDER)
    {0U},
#else
    {1U},
#endif
#if defined(MAMORI_DEFECT_PORT_WINDOW)
    256U,
#else
    3U,
#endif
#if defined(MAMORI_DEFECT_PORT_DEMANDS)
    {{1U, 0U}, {0U, 0U}, {1U, 0U}},  // a silent channel would stay valid
#else
    {{1U, 0U}, {1U, 0U}, {1U, 0U}},
#endif
};

#if defined(MAMORI_DEFECT_PORT_OUT_ROOM)
using OutFrame = E2eFrame<27U>;
#else
using OutFrame = E2eFrame<28U>;
#endif
#if defined(MAMORI_DEFECT_PORT_IN_ROOM)
using InFrame = E2eFrame<27U>;
#else
using InFrame = E2eFrame<28U>;
#endif

MAMORI_CONSTINIT mamori::OutPort<OutFrame> g_out{mamori::kNoOwner, "out"};
MAMORI_CONSTINIT mamori::InPort<InFrame> g_in{mamori::kNoOwner, "in"};
MAMORI_CONSTINIT E2eOutPort<SafeSpeed, OutFrame> g_sender{g_out};
#if defined(MAMORI_DEFECT_PORT_WITHOUT_SUBSTITUTE)
MAMORI_CONSTINIT E2eInPort<SafeSpeed, kPortLimits, mamori::InPort<InFrame>> g_receiver{g_in};
#else
MAMORI_CONSTINIT E2eInPort<SafeSpeed, kPortLimits, mamori::InPort<InFrame>> g_receiver{g_in, {}};
#endif

void work(mamori::Instant now) {
    Speed speed{};
#if defined(MAMORI_DEFECT_WORTH_IGNORED)
    g_receiver.read(now, speed);
#else
    static_cast<void>(g_receiver.read(now, speed));
#endif
    static_cast<void>(g_sender.write(speed));
}

}  // namespace defects
