// SPDX-License-Identifier: Apache-2.0
/// @file
/// Crash record in the file of a flight recorder. It has its own space after the last slot, so it does not
/// interfere with a record that is being written. This file converts between bytes and values only.
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

/// The last recorded crash.
struct CrashNote {
    Instant time{};             ///< on the time line of its session
    std::uint64_t address{0U};  ///< inaccessible address, or that of the instruction; 0 if is_sent
    std::uint32_t session{0U};  ///< session of the flight recorder, from 1
    CrashPlace place{};         ///< position of the thread that crashed
    std::uint8_t signal{0U};    ///< signal number (SIGSEGV, ...), from 1
    bool is_sent{false};        ///< by kill(), raise() or abort(), not by an instruction
};

/// [byte] Smaller than a slot, so a reader without support for crash records still accepts the file as a
/// recorder.
inline constexpr std::size_t kCrashNoteSize = 30U;
static_assert(kCrashNoteSize < flight::kRecordSize);
using CrashNoteBytes = std::array<std::uint8_t, kCrashNoteSize>;

enum class CrashNoteState : std::uint8_t {
    kEmpty,    ///< no crash recorded
    kWhole,    ///< valid crash record
    kDamaged,  ///< incompletely written, or changed afterwards
};

/// Size of a file with `capacity` records and a crash record [byte]. @param[in] capacity from 1.
constexpr std::size_t calc_recorder_file_size(std::size_t capacity) noexcept {
    return flight::calc_region_size(capacity) + kCrashNoteSize;
}
/// Part of the file that the recorder uses.
/// @param[in] file at least kCrashNoteSize bytes; a smaller file is a contract violation, also in the
///            functions below.
inline Span<std::byte> get_recorder_region(Span<std::byte> file) noexcept {
    MAMORI_REQUIRE(1, file.size() >= kCrashNoteSize);
    return file.subspan(0U, file.size() - kCrashNoteSize);
}

CrashNoteBytes encode_crash_note(const CrashNote& note) noexcept;
/// @param[out] note written on kWhole only.
CrashNoteState decode_crash_note(const CrashNoteBytes& bytes, CrashNote& note) noexcept;

/// Stores a crash record at the end of the file. Async-signal-safe: only stores to memory.
void write_crash_note(Span<std::byte> file, const CrashNote& note) noexcept;
/// Reads the crash record of this or an earlier session. The record remains until the next crash.
CrashNoteState read_crash_note(Span<const std::byte> file, CrashNote& note) noexcept;

}  // namespace mamori::ports::posix_rt

#endif  // MAMORI_PORTS_POSIX_RT_CRASH_NOTE_HPP
