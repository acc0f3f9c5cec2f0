// SPDX-License-Identifier: Apache-2.0
#include "mamori/ports/posix_rt/crash_note.hpp"

#include <algorithm>

#include "mamori/kernel/base/crc32.hpp"

namespace mamori::ports::posix_rt {
namespace {

constexpr std::size_t kAddressOffset = 8U;
constexpr std::size_t kSessionOffset = 16U;
constexpr std::size_t kWindowOffset = 20U;
constexpr std::size_t kComponentOffset = 22U;
constexpr std::size_t kSignalOffset = 24U;
constexpr std::size_t kSentOffset = 25U;
constexpr std::size_t kCrcOffset = 26U;

/// Little-endian, on every processor.
void put(CrashNoteBytes& bytes, std::size_t offset, std::uint64_t value, std::size_t size) noexcept {
    for (std::size_t i = 0U; i < size; ++i) {
        bytes[offset + i] = static_cast<std::uint8_t>((value >> (8U * i)) & 0xFFU);
    }
}

template <typename T>
T get(const CrashNoteBytes& bytes, std::size_t offset) noexcept {
    std::uint64_t value = 0U;
    for (std::size_t i = 0U; i < sizeof(T); ++i) {
        value |= static_cast<std::uint64_t>(bytes[offset + i]) << (8U * i);
    }
    return static_cast<T>(value);
}

std::uint32_t calc_crc(const CrashNoteBytes& bytes) noexcept {
    Crc32 crc;
    for (std::size_t i = 0U; i < kCrcOffset; ++i) {
        crc.add(bytes[i]);
    }
    return crc.get_value();
}

}  // namespace

CrashNoteBytes encode_crash_note(const CrashNote& note) noexcept {
    CrashNoteBytes bytes{};
    put(bytes, 0U, static_cast<std::uint64_t>(note.time.ns), sizeof note.time.ns);
    put(bytes, kAddressOffset, note.address, sizeof note.address);
    put(bytes, kSessionOffset, note.session, sizeof note.session);
    put(bytes, kWindowOffset, note.place.window, sizeof note.place.window);
    put(bytes, kComponentOffset, note.place.component, sizeof note.place.component);
    put(bytes, kSignalOffset, note.signal, sizeof note.signal);
    put(bytes, kSentOffset, note.is_sent ? 1U : 0U, 1U);
    put(bytes, kCrcOffset, calc_crc(bytes), sizeof(std::uint32_t));
    return bytes;
}

CrashNoteState decode_crash_note(const CrashNoteBytes& bytes, CrashNote& note) noexcept {
    if (std::all_of(bytes.begin(), bytes.end(), [](std::uint8_t byte) { return byte == 0U; })) {
        return CrashNoteState::kEmpty;
    }
    if (get<std::uint32_t>(bytes, kCrcOffset) != calc_crc(bytes) || bytes[kSignalOffset] == 0U ||
        bytes[kSentOffset] > 1U) {
        return CrashNoteState::kDamaged;
    }
    note.time = Instant{get<std::int64_t>(bytes, 0U)};
    note.address = get<std::uint64_t>(bytes, kAddressOffset);
    note.session = get<std::uint32_t>(bytes, kSessionOffset);
    note.place = {get<std::uint16_t>(bytes, kWindowOffset), get<std::uint16_t>(bytes, kComponentOffset)};
    note.signal = bytes[kSignalOffset];
    note.is_sent = bytes[kSentOffset] == 1U;
    return CrashNoteState::kWhole;
}

void write_crash_note(Span<std::byte> file, const CrashNote& note) noexcept {
    const CrashNoteBytes bytes = encode_crash_note(note);
    const std::size_t begin = get_recorder_region(file).size();
    for (std::size_t i = 0U; i < kCrashNoteSize; ++i) {
        file[begin + i] = std::byte{bytes[i]};
    }
}

CrashNoteState read_crash_note(Span<const std::byte> file, CrashNote& note) noexcept {
    MAMORI_REQUIRE(1, file.size() >= kCrashNoteSize);
    CrashNoteBytes bytes{};
    const std::size_t begin = file.size() - kCrashNoteSize;
    for (std::size_t i = 0U; i < kCrashNoteSize; ++i) {
        bytes[i] = std::to_integer<std::uint8_t>(file[begin + i]);
    }
    return decode_crash_note(bytes, note);
}

}  // namespace mamori::ports::posix_rt
