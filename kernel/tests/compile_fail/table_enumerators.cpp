// SPDX-License-Identifier: Apache-2.0
// Broken: enumerators of a table that its rows could not tell apart; MAMORI_BREAK says which.
#include "mamori/kernel/system/system.hpp"
#include "parts.hpp"

#ifndef MAMORI_BREAK
#define MAMORI_BREAK 0
#endif

template <int kNumber>
using Underlying = std::conditional_t<MAMORI_BREAK == kNumber, std::uint64_t, std::uint32_t>;
enum class Command : Underlying<1>{kStart = 0xFFFFFFFFU};
enum class OtherCommand : std::uint8_t { kStop };
enum class Trouble : Underlying<2>{kHot};
enum class Answer : Underlying<3>{kStop};
enum class Mishap : Underlying<4>{kLoud};

constexpr auto kSystem = mamori::system(
    mamori::frame(1_ms), mamori::window("all", 0_us, 100_us, mamori::budget(50_us), mamori::run(g_producer)),
    mamori::system_mode("idle", mamori::runs(g_producer)),
    mamori::system_mode("work", mamori::runs(g_producer)),
    mamori::safe_mode("halt", mamori::runs(g_producer)),
    mamori::mode_transition("idle", Command::kStart, "work"),
#if MAMORI_BREAK == 5
    mamori::mode_transition("work", OtherCommand::kStop, "idle"),
#endif
#if MAMORI_BREAK == 4
    mamori::faults<Mishap::kLoud>(),
#endif
    mamori::faults<Trouble::kHot>(), mamori::react(Trouble::kHot, Answer::kStop, mamori::within(1_ms)));
MAMORI_CHECK(kSystem);
