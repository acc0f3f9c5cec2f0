// SPDX-License-Identifier: Apache-2.0
// What the compiler rejects: faults and reactions.
// Each namespace compiles, and does not with its MAMORI_BREAK_<NAME>.
#include "mamori/kernel/system/system.hpp"
#include "parts.hpp"

// A declared fault leads to nothing.
namespace fault_without_reaction {
constexpr auto kSystem =
    mamori::system(mamori::frame(1_ms), mamori::faults<Fault::kOverspeed, Fault::kTrackingLost>(),
#ifndef MAMORI_BREAK_FAULT_WITHOUT_REACTION
                   mamori::react(Fault::kTrackingLost, Reaction::kSto, mamori::within(20_ms)),
#endif
                   mamori::react(Fault::kOverspeed, Reaction::kSs1, mamori::within(20_ms)));
MAMORI_CHECK(kSystem);
}  // namespace fault_without_reaction

// A declared fault leads to two reactions.
namespace fault_with_two_reactions {
constexpr auto kSystem =
    mamori::system(mamori::frame(1_ms), mamori::faults<Fault::kOverspeed>(),
#ifdef MAMORI_BREAK_FAULT_WITH_TWO_REACTIONS
                   mamori::react(Fault::kOverspeed, Reaction::kSto, mamori::within(20_ms)),
#endif
                   mamori::react(Fault::kOverspeed, Reaction::kSs1, mamori::within(20_ms)));
MAMORI_CHECK(kSystem);
}  // namespace fault_with_two_reactions

// A fault that stands in the list of faults twice.
namespace fault_declared_twice {
#ifdef MAMORI_BREAK_FAULT_DECLARED_TWICE
constexpr auto kFaults = mamori::faults<Fault::kOverspeed, Fault::kOverspeed>();
#else
constexpr auto kFaults = mamori::faults<Fault::kOverspeed>();
#endif
constexpr auto kSystem = mamori::system(
    mamori::frame(1_ms), mamori::window("a", 0_us, 100_us, mamori::budget(50_us), mamori::run(g_producer)),
    kFaults, mamori::react(Fault::kOverspeed, Reaction::kSto, mamori::within(1_ms)));
MAMORI_CHECK(kSystem);
}  // namespace fault_declared_twice

// A reaction has no time to come.
namespace reaction_without_time {
#ifdef MAMORI_BREAK_REACTION_WITHOUT_TIME
constexpr mamori::Duration kLimit = 0_ms;
#else
constexpr mamori::Duration kLimit = 1_ns;
#endif
constexpr auto kSystem =
    mamori::system(mamori::frame(1_ms), mamori::faults<Fault::kOverspeed>(),
                   mamori::react(Fault::kOverspeed, Reaction::kSs1, mamori::within(kLimit)));
MAMORI_CHECK(kSystem);
}  // namespace reaction_without_time

// An enumerator of another enumeration has the number of the declared fault.
namespace faults_of_two_enumerations {
enum class OtherFault { kDoorOpen };
#ifdef MAMORI_BREAK_FAULTS_OF_TWO_ENUMERATIONS
constexpr auto kAnswered = OtherFault::kDoorOpen;
#else
constexpr auto kAnswered = Fault::kOverspeed;
#endif
constexpr auto kSystem = mamori::system(
    mamori::frame(1_ms), mamori::window("a", 0_us, 100_us, mamori::budget(50_us), mamori::run(g_producer)),
    mamori::faults<Fault::kOverspeed>(), mamori::react(kAnswered, Reaction::kSto, mamori::within(1_ms)));
MAMORI_CHECK(kSystem);
}  // namespace faults_of_two_enumerations

// Reactions of two enumerations share their numbers.
namespace reactions_of_two_enumerations {
enum class OtherReaction { kBeep };
#ifdef MAMORI_BREAK_REACTIONS_OF_TWO_ENUMERATIONS
constexpr auto kSecond = OtherReaction::kBeep;
#else
constexpr auto kSecond = Reaction::kSs1;
#endif
constexpr auto kSystem = mamori::system(
    mamori::frame(1_ms), mamori::window("a", 0_us, 100_us, mamori::budget(50_us), mamori::run(g_producer)),
    mamori::faults<Fault::kOverspeed, Fault::kTrackingLost>(),
    mamori::react(Fault::kOverspeed, Reaction::kSto, mamori::within(1_ms)),
    mamori::react(Fault::kTrackingLost, kSecond, mamori::within(1_ms)));
MAMORI_CHECK(kSystem);
}  // namespace reactions_of_two_enumerations

// A declared fault has no reaction in one of the modes.
namespace fault_without_reaction_in_a_mode {
enum class Mode { kWork, kHalt };
constexpr auto kSystem = mamori::system(
    mamori::frame(1_ms), mamori::window("a", 0_us, 100_us, mamori::budget(50_us), mamori::run(g_producer)),
    mamori::system_mode("work", mamori::runs(g_producer)),
    mamori::safe_mode("halt", mamori::runs(g_producer)), mamori::faults<Fault::kOverspeed>(),
#ifndef MAMORI_BREAK_FAULT_WITHOUT_REACTION_IN_A_MODE
    mamori::react(Fault::kOverspeed, Reaction::kSto, mamori::within(1_ms), mamori::in_modes<Mode::kHalt>()),
#endif
    mamori::react(Fault::kOverspeed, Reaction::kSs1, mamori::within(1_ms), mamori::in_modes<Mode::kWork>()));
MAMORI_CHECK(kSystem);
}  // namespace fault_without_reaction_in_a_mode

// A declared fault has two reactions in one of the modes.
namespace fault_with_two_reactions_in_a_mode {
enum class Mode { kWork, kHalt };
constexpr auto kSystem = mamori::system(
    mamori::frame(1_ms), mamori::window("a", 0_us, 100_us, mamori::budget(50_us), mamori::run(g_producer)),
    mamori::system_mode("work", mamori::runs(g_producer)),
    mamori::safe_mode("halt", mamori::runs(g_producer)), mamori::faults<Fault::kOverspeed>(),
#ifdef MAMORI_BREAK_FAULT_WITH_TWO_REACTIONS_IN_A_MODE
    mamori::react(Fault::kOverspeed, Reaction::kSto, mamori::within(1_ms), mamori::in_modes<Mode::kHalt>()),
#endif
    mamori::react(Fault::kOverspeed, Reaction::kSs1, mamori::within(1_ms)));
MAMORI_CHECK(kSystem);
}  // namespace fault_with_two_reactions_in_a_mode

// A reaction names a mode that the table does not have.
namespace reaction_in_unknown_mode {
enum class Mode { kWork, kHalt, kTeach };
#ifdef MAMORI_BREAK_REACTION_IN_UNKNOWN_MODE
constexpr auto kModes = mamori::in_modes<Mode::kWork, Mode::kHalt, Mode::kTeach>();
#else
constexpr auto kModes = mamori::in_modes<Mode::kWork, Mode::kHalt>();
#endif
constexpr auto kSystem = mamori::system(
    mamori::frame(1_ms), mamori::window("a", 0_us, 100_us, mamori::budget(50_us), mamori::run(g_producer)),
    mamori::system_mode("work", mamori::runs(g_producer)),
    mamori::safe_mode("halt", mamori::runs(g_producer)), mamori::faults<Fault::kOverspeed>(),
    mamori::react(Fault::kOverspeed, Reaction::kSs1, mamori::within(1_ms), kModes));
MAMORI_CHECK(kSystem);
}  // namespace reaction_in_unknown_mode
