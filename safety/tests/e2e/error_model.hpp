// SPDX-License-Identifier: Apache-2.0
/// @file
/// Which error patterns pass, by the definition of the profiles: division by the polynomial, bit by bit, of
/// the errors alone. Shares no code with what it is compared with.
#ifndef MAMORI_SAFETY_TESTS_E2E_ERROR_MODEL_HPP
#define MAMORI_SAFETY_TESTS_E2E_ERROR_MODEL_HPP

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "error_patterns.hpp"

namespace mamori::safety::rig {

/// What an error must not touch, and what it is divided by. Bits are counted from the first byte's most
/// significant one.
struct ErrorRules {
    unsigned width{8U};
    std::uint64_t polynomial{0U};
    bool is_reflected{false};
    std::size_t crc_at{0U};  ///< [bytes]
    bool is_little_endian{false};
    std::vector<std::array<std::size_t, 2U>>
        compared{};          ///< bits of fields that the receiver compares: first, behind last
    bool has_nibble{false};  ///< the counter is in bits 12 .. 15
    std::array<std::uint8_t, 16U> before{};  ///< byte in front of the frame that changes with the counter
    std::array<std::uint8_t, 16U> behind{};  ///< byte behind it
    std::uint32_t counter_max{15U};          ///< of a nibble
};

/// The rules of a case of rig.hpp.
template <typename Case>
ErrorRules get_rules() {
    constexpr std::uint64_t kP4 = 0xF4ACFB13U;
    switch (Case::Profile::kNumber) {
        case 4U:
        case 44U:
            return {32U, kP4, true, 8U, false, {{0U, 16U}, {32U, 64U}}};
        case 7U:
            return {64U, 0x42F0E1EBA9EA3693U, true, 0U, false, {{64U, 96U}, {128U, 160U}}};
        case 8U:
            return {32U, kP4, true, 0U, false, {{32U, 64U}, {96U, 128U}}};
        case 5U:
            return {16U, 0x1021U, false, 0U, true};
        case 6U:
            return {16U, 0x1021U, false, 0U, false, {{16U, 32U}}};
        default:
            break;
    }
    ErrorRules rules{8U, 0x2FU};
    rules.has_nibble = true;
    if constexpr (Case::Profile::kNumber == 2U || Case::Profile::kNumber == 22U) {
        rules.behind = Case::make(16U).data_ids;
    } else if constexpr (Case::Profile::kNumber == 1U || Case::Profile::kNumber == 11U) {
        const NibbleCounterChannel channel = Case::make(16U);
        rules.polynomial = 0x1DU;
        rules.counter_max = 14U;
        if (channel.mode == DataIdMode::kNibble) {
            rules.compared = {{8U, 12U}};
        }
        for (std::size_t counter = 0U; counter < 16U && channel.mode == DataIdMode::kAlternating; ++counter) {
            rules.before[counter] =
                static_cast<std::uint8_t>(counter % 2U == 0U ? channel.data_id : channel.data_id >> 8U);
        }
    }
    return rules;
}

/// Errors as they are seen by division; same members as RealTrial.
class ModelTrial final {
  public:
    ModelTrial(const ErrorRules& rules, std::size_t length)
        : rules_(rules), syndromes_(length * 8U), is_compared_(length * 8U), is_turned_(length * 8U) {
        for (std::size_t bit = 0U; bit < syndromes_.size(); ++bit) {
            Frame error(length);
            error[bit / 8U] = std::byte{0x80U} >> (bit % 8U);
            syndromes_[bit] = calc_syndrome(error, 0U, 0U);
        }
        for (const auto& [first, last] : rules.compared) {
            for (std::size_t bit = first; bit < last; ++bit) {
                is_compared_[bit] = true;
            }
        }
        for (std::uint32_t turned = 0U; turned < 16U; ++turned) {
            const std::uint32_t counter = kTrialCounter ^ turned;
            jumps_[turned] = calc_syndrome(
                Frame(length), static_cast<std::uint8_t>(rules.before[counter] ^ rules.before[kTrialCounter]),
                static_cast<std::uint8_t>(rules.behind[counter] ^ rules.behind[kTrialCounter]));
        }
    }

    std::size_t get_bit_count() const { return syndromes_.size(); }
    void turn(std::size_t bit) {
        is_turned_[bit] = !is_turned_[bit];
        syndrome_ ^= syndromes_[bit];
        if (is_compared_[bit]) {
            compared_count_ += is_turned_[bit] ? 1U : ~std::size_t{0U};
        }
        if (rules_.has_nibble && bit >= 12U && bit <= 15U) {
            turned_counter_ ^= 1U << (15U - bit);
        }
    }
    bool passes() const {
        if (rules_.has_nibble && (kTrialCounter ^ turned_counter_) > rules_.counter_max) {
            return false;
        }
        return compared_count_ == 0U &&
               (syndrome_ ^ (rules_.has_nibble ? jumps_[turned_counter_] : 0U)) == 0U;
    }

  private:
    /// Remainder of the bytes of `error` without its checksum, with that checksum added: 0 passes.
    std::uint64_t calc_syndrome(const Frame& error, std::uint8_t before, std::uint8_t behind) const {
        const std::size_t bytes = rules_.width / 8U;
        Frame divided{std::byte{before}};
        const auto crc = error.begin() + static_cast<std::ptrdiff_t>(rules_.crc_at);
        divided.insert(divided.end(), error.begin(), crc);
        divided.insert(divided.end(), crc + static_cast<std::ptrdiff_t>(bytes), error.end());
        divided.push_back(std::byte{behind});
        if (rules_.width == 16U) {
            divided.push_back(std::byte{0U});  // the second byte of the identifier
        }
        if (rules_.behind == std::array<std::uint8_t, 16U>{} && rules_.width != 16U) {
            divided.pop_back();
        }
        std::uint64_t rest = divide(divided);
        for (std::size_t i = 0U; i < bytes; ++i) {
            const std::size_t place = rules_.is_little_endian ? i : bytes - 1U - i;
            rest ^= std::to_integer<std::uint64_t>(crc[static_cast<std::ptrdiff_t>(i)]) << (8U * place);
        }
        return rest;
    }
    std::uint64_t divide(const Frame& bytes) const {
        const unsigned top = rules_.width - 1U;
        const std::uint64_t mask = ~std::uint64_t{0U} >> (63U - top);
        std::uint64_t rest = 0U;
        for (const std::byte byte : bytes) {
            for (unsigned i = 0U; i < 8U; ++i) {
                const unsigned place = rules_.is_reflected ? i : 7U - i;
                const std::uint64_t in = (std::to_integer<std::uint64_t>(byte) >> place) & 1U;
                const bool feeds_back = ((rest >> top) & 1U) != in;
                rest = (rest << 1U) & mask;
                rest ^= feeds_back ? rules_.polynomial : 0U;
            }
        }
        if (!rules_.is_reflected) {
            return rest;
        }
        std::uint64_t turned = 0U;
        for (unsigned bit = 0U; bit <= top; ++bit) {
            turned |= ((rest >> bit) & 1U) << (top - bit);
        }
        return turned;
    }

    ErrorRules rules_;
    std::vector<std::uint64_t> syndromes_;
    std::vector<bool> is_compared_;
    std::vector<bool> is_turned_;
    std::array<std::uint64_t, 16U> jumps_{};  ///< what another byte for another counter adds
    std::uint64_t syndrome_{0U};
    std::size_t compared_count_{0U};
    std::size_t turned_counter_{0U};
};

}  // namespace mamori::safety::rig

#endif  // MAMORI_SAFETY_TESTS_E2E_ERROR_MODEL_HPP
