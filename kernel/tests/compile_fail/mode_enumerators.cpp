// SPDX-License-Identifier: Apache-2.0
// What the compiler rejects: enumerators of modes that do not name them; MAMORI_BREAK says which.
#include "mamori/kernel/run/system_modes.hpp"
#include "parts.hpp"

#ifndef MAMORI_BREAK
#define MAMORI_BREAK 0
#endif

enum class Mode { kIdle, kWork, kHalt, kNone };
enum class OtherMode { kIdle, kWork, kHalt };
enum class Command { kStart };

constexpr auto kSystem = mamori::system(
    mamori::frame(1_ms), mamori::window("all", 0_us, 100_us, mamori::budget(50_us), mamori::run(g_producer)),
#if MAMORI_BREAK == 1
    mamori::system_mode("idle", mamori::runs(g_producer)),
#elif MAMORI_BREAK == 2
    mamori::system_mode<Mode::kNone>("idle", mamori::runs(g_producer)),
#else
    mamori::system_mode<Mode::kIdle>("idle", mamori::runs(g_producer)),
#endif
#if MAMORI_BREAK == 3
    mamori::system_mode<OtherMode::kWork>("work", mamori::runs(g_producer)),
#else
    mamori::system_mode<Mode::kWork>("work", mamori::runs(g_producer)),
#endif
    mamori::safe_mode<Mode::kHalt>("halt", mamori::runs(g_producer)),
    mamori::mode_transition("idle", Command::kStart, "work"));
MAMORI_CHECK(kSystem);

inline mamori::SystemModes g_modes{mamori::make_view(kSystem)};
#if MAMORI_BREAK == 4
using Asked = int;
#else
using Asked = Mode;
#endif
inline Asked ask() noexcept {
    return g_modes.get_mode<Asked>();
}
