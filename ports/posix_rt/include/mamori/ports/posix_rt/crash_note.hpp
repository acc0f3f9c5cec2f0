// SPDX-License-Identifier: Apache-2.0
/// @file
/// What a crash leaves in the file of the flight recorder: a note of its own behind the last slot, so that it
/// does not matter whether a record was being written. Bytes and values, nothing else.
///
/// @satisfies SWR-PRT-027      Design: docs/design/posix_rt.md#crash-note
#ifndef MAMORI_PORTS_POSIX_RT_CRASH_NOTE_HPP
#define MAMORI_PORTS_POSIX_RT_CRASH_NOTE_HPP

#include <array>
#include <cstddef>
#include <cstdint>

#include "mamori/kernel/base/span.hpp"
#include "mamori/kernel/base/time.hpp"
#include "mamori/kernel/record/flight_format.hpp"
#include "mamori/ports/posix_rt/crash_place.hpp"

namespace mamori::ports::posix_rt {

/// The last crash that the file knows.
struct CrashNote {
    Instant time{};             ///< on the time line of its session
    std::uint64_t address{0U};  ///< that the code could not reach, or of the instruction; 0 when it was sent
    std::uint32_t session{0U};  ///< of the flight recorder, from 1 on
    CrashPlace place{};         ///< of the thread that crashed
    std::uint8_t signal{0U};    ///< SIGSEGV, ...: from 1 on
    bool is_sent{false};  ///< by kill(), raise() or abort(), so not by an instruction that could not go on
};

/// [byte] Less than a slot, so a reader that knows of no notes takes the file for a recorder all the same.
inline constexpr std::size_t kCrashNoteSize = 30U;
static_assert(kCrashNoteSize < flight::kRecordSize);
using CrashNoteBytes = std::array<std::uint8_t, kCrashNoteSize>;

enum class CrashNoteState : std::uint8_t {
    kEmpty,    ///< no crash so far
    kWhole,    ///< a note
    kDamaged,  ///< the process ended while it was written, or it was changed since
};

/// Bytes of a file with `capacity` records and a note. @param[in] capacity from 1 on.
constexpr std::size_t calc_recorder_file_size(std::size_t capacity) noexcept {
    return flight::calc_region_size(capacity) + kCrashNoteSize;
}
/// What of such a file is the recorder's. @param[in] file at least kCrashNoteSize bytes, here and below; else
/// an own bug.
inline Span<std::byte> get_recorder_region(Span<std::byte> file) noexcept {
    MAMORI_REQUIRE(1, file.size() >= kCrashNoteSize);
    return file.subspan(0U, file.size() - kCrashNoteSize);
}

CrashNoteBytes encode_crash_note(const CrashNote& note) noexcept;
/// @param[out] note set when kWhole.
CrashNoteState decode_crash_note(const CrashNoteBytes& bytes, CrashNote& note) noexcept;

/// Stores a note at the end of the file. Safe in a signal handler: stores to memory, and nothing else.
void write_crash_note(Span<std::byte> file, const CrashNote& note) noexcept;
/// The note that a crash of this or an earlier session has left; it stays until the next one.
CrashNoteState read_crash_note(Span<const std::byte> file, CrashNote& note) noexcept;

}  // namespace mamori::ports::posix_rt

#endif  // MAMORI_PORTS_POSIX_RT_CRASH_NOTE_HPP
