// SPDX-License-Identifier: Apache-2.0
/// @file
/// Messages between the safety system and the parallel process, and notes of that process about its own
/// faults.
#ifndef MAMORI_PARTITION_FAULTS_MESSAGES_HPP
#define MAMORI_PARTITION_FAULTS_MESSAGES_HPP

#include <csignal>
#include <cstddef>
#include <cstdint>

#include "mamori/kernel/base/crc32.hpp"
#include "mamori/kernel/payload/fields.hpp"

namespace mamori::partition_faults {

/// To the partition, in each frame.
struct Request {
    std::uint64_t sequence{0U};
};

/// From the partition, in each frame. `check` represents the end-to-end protection of a real message.
struct Answer {
    std::uint64_t sequence{0U};
    std::uint64_t request{0U};  ///< that this message answers
    std::uint32_t check{0U};
};

/// CRC of all members except the CRC itself.
constexpr std::uint32_t calc_check(const Answer& answer) noexcept {
    Crc32 crc;
    for (const std::uint64_t value : {answer.sequence, answer.request}) {
        for (unsigned shift = 0U; shift < 64U; shift += 8U) {
            crc.add(static_cast<std::uint8_t>(value >> shift));
        }
    }
    return crc.get_value();
}

/// Indices in the descriptors that the partition receives.
inline constexpr int kRequestPlace{0};
inline constexpr int kAnswerPlace{1};
inline constexpr int kDiaryPlace{2};

/// A note of the partition about itself: one byte, stored under its instant.
enum class Note : std::uint8_t {
    kRuns,  ///< listens to the signals below
    kBegun,
    kDone,  ///< flood: kFloodBurst messages sent; corruption: each word written once; the fault continues
};
inline constexpr std::size_t kNoteCapacity{1U};
inline constexpr int kFloodSignal{SIGUSR1};
inline constexpr int kCorruptionSignal{SIGUSR2};
inline constexpr int kFloodBurst{4096};

}  // namespace mamori::partition_faults

MAMORI_FIELDS(mamori::partition_faults::Request, sequence)
MAMORI_FIELDS(mamori::partition_faults::Answer, sequence, request, check)

#endif  // MAMORI_PARTITION_FAULTS_MESSAGES_HPP
