// SPDX-License-Identifier: Apache-2.0
/// @file
/// Counts the error patterns that a profile lets pass: each is put into a good frame and read by the real
/// code.
#ifndef MAMORI_SAFETY_TESTS_E2E_ERROR_PATTERNS_HPP
#define MAMORI_SAFETY_TESTS_E2E_ERROR_PATTERNS_HPP

#include <cstddef>
#include <cstdint>

#include "rig.hpp"

namespace mamori::safety::rig {

/// Patterns of exactly `weight` turned bits from bit `first` on that pass.
/// @param[in] trial has get_bit_count(), turn(bit) and passes().
template <typename Trial>
std::uint64_t count_weight(Trial& trial, unsigned weight, std::size_t first = 0U) {
    if (weight == 0U) {
        return trial.passes() ? 1U : 0U;
    }
    std::uint64_t count = 0U;
    for (std::size_t bit = first; bit + weight <= trial.get_bit_count(); ++bit) {
        trial.turn(bit);
        count += count_weight(trial, weight - 1U, bit + 1U);
        trial.turn(bit);
    }
    return count;
}

template <typename Trial>
void turn_all(Trial& trial, std::uint64_t bits, std::size_t first) {
    for (std::size_t bit = first; bits != 0U; bits >>= 1U, ++bit) {
        if ((bits & 1U) != 0U) {
            trial.turn(bit);
        }
    }
}

/// Bursts that pass: patterns whose first and last turned bit are at most `width` bits apart, both included,
/// in the order in which bytes lie in the frame, most significant bit first.
template <typename Trial>
std::uint64_t count_bursts(Trial& trial, unsigned width) {
    std::uint64_t count = 0U;
    for (std::size_t first = 0U; first < trial.get_bit_count(); ++first) {
        const std::size_t left = trial.get_bit_count() - first - 1U;
        const std::size_t inner = left < width - 1U ? left : width - 1U;
        trial.turn(first);
        std::uint64_t pattern = 0U;
        for (std::uint64_t next = 0U; next < (std::uint64_t{1U} << inner); ++next) {
            // From one pattern to the next by a Gray code: one bit turns.
            const std::uint64_t gray = next ^ (next >> 1U);
            turn_all(trial, pattern ^ gray, first + 1U);
            pattern = gray;
            count += trial.passes() ? 1U : 0U;
        }
        turn_all(trial, pattern, first + 1U);
        trial.turn(first);
    }
    return count;
}

constexpr std::uint32_t kTrialCounter = 5U;

/// A good frame into which errors are put, one after the other; the real code reads it.
template <typename Case>
class RealTrial final {
    using Profile = typename Case::Profile;

  public:
    explicit RealTrial(std::size_t length)
        : channel_(Case::make(length)), frame_(protect<Profile>(channel_, kTrialCounter, length)) {}

    std::size_t get_bit_count() const { return frame_.size() * 8U; }
    void turn(std::size_t bit) { frame_[bit / 8U] ^= std::byte{0x80U} >> (bit % 8U); }
    bool passes() const {
        std::uint32_t counter = 0U;
        return Profile::read(channel_, view(frame_), counter) == FrameCause::kGood;
    }

  private:
    typename Profile::Channel channel_;
    Frame frame_;
};

/// Bursts of up to `width` bits that pass, by linear algebra: patterns of a window add up to nothing exactly
/// where the syndromes of its bits depend on each other. For checksums too wide to try each pattern.
/// Bits of a byte are in the order in which the checksum takes them. Windows that touch the checksum itself
/// are left out: across its edge a burst is none of the code word.
/// @return number of the other windows in which the syndromes are not independent; 0 when every burst is
/// seen.
template <const auto& kCrc>
std::size_t count_dependent_windows(std::size_t length, std::size_t crc_at) {
    using Word = typename Crc<kCrc>::Word;
    constexpr std::size_t kBytes = sizeof(Word);
    const std::size_t bits = length * 8U;
    const auto calc = [&](const Frame& frame) {
        Crc<kCrc> crc;
        crc.add({frame.data(), crc_at});
        crc.add({frame.data() + crc_at + kBytes, length - crc_at - kBytes});
        return crc.get_value();
    };
    const Word base = calc(Frame(length));
    std::vector<Word> syndromes;
    for (std::size_t bit = 0U; bit < bits; ++bit) {
        Frame frame(length);
        frame[bit / 8U] = kCrc.is_reflected ? std::byte{1U} << (bit % 8U) : std::byte{0x80U} >> (bit % 8U);
        syndromes.push_back(static_cast<Word>(calc(frame) ^ base));
    }
    std::size_t dependent = 0U;
    for (std::size_t first = 0U; first + kBytes * 8U <= bits; ++first) {
        if (first < (crc_at + kBytes) * 8U && first + kBytes * 8U > crc_at * 8U) {
            continue;
        }
        std::vector<Word> basis;
        for (std::size_t bit = first; bit < first + kBytes * 8U; ++bit) {
            Word rest = syndromes[bit];
            for (const Word vector : basis) {
                const auto reduced = static_cast<Word>(rest ^ vector);
                rest = reduced < rest ? reduced : rest;
            }
            if (rest != 0U) {
                basis.push_back(rest);
            }
        }
        dependent += basis.size() < kBytes * 8U ? 1U : 0U;
    }
    return dependent;
}

}  // namespace mamori::safety::rig

#endif  // MAMORI_SAFETY_TESTS_E2E_ERROR_PATTERNS_HPP
