// SPDX-License-Identifier: Apache-2.0
/// @file
/// How likely a damaged frame passes, calculated by the compiler: exactly for 8-bit checksums, as a bound for
/// wider ones, from stored facts about 16- and 32-bit checksums. `./mamori e2e` tells the exact values.
///
/// @satisfies SWR-E2E-022, SWR-E2E-023      Design: docs/design/e2e.md#residual-error
#ifndef MAMORI_SAFETY_E2E_RESIDUAL_ERROR_HPP
#define MAMORI_SAFETY_E2E_RESIDUAL_ERROR_HPP

#include <array>
#include <cstddef>
#include <cstdint>

#include "mamori/kernel/base/span.hpp"
#include "mamori/safety/e2e/crc_catalogue.hpp"
#include "mamori/safety/e2e/profile_01.hpp"
#include "mamori/safety/e2e/profile_02.hpp"
#include "mamori/safety/e2e/profile_04.hpp"
#include "mamori/safety/e2e/profile_05.hpp"
#include "mamori/safety/e2e/wire.hpp"

namespace mamori::safety {

namespace detail {

/// Error patterns that pass in frames of one length.
struct ResidualFacts {
    std::size_t length;              ///< of the frame with its header [bytes]
    std::uint32_t distance;          ///< fewest turned bits that may pass
    std::uint64_t patterns;          ///< how many patterns of so many bits pass, below 2^53
    std::uint32_t share_hundredths;  ///< greatest share of any higher weight that passes [2^-width / 100]
};

/// Checksum of all rows: a row that was changed by hand does not compile.
template <std::size_t kRows>
constexpr std::uint32_t calc_fingerprint(const std::array<ResidualFacts, kRows>& rows) noexcept {
    Crc<kCrc32, 1U> crc;
    for (const ResidualFacts& row : rows) {
        const std::array<std::uint64_t, 4U> values{row.length, row.distance, row.patterns,
                                                   row.share_hundredths};
        for (const std::uint64_t value : values) {
            for (unsigned place = 0U; place < sizeof(value); ++place) {
                crc.add(get_byte(value, place));
            }
        }
    }
    return crc.get_value();
}

// clang-format off: a row per line, all written by tools/mamori_tools/e2e/facts.py
/// Profiles 5 and 6.
inline constexpr std::array kResidualFacts16{
    ResidualFacts{3U, 8U, 27U, 293U},
    ResidualFacts{4U, 6U, 22U, 206U},
    ResidualFacts{5U, 4U, 8U, 217U},
    ResidualFacts{6U, 4U, 16U, 236U},
    ResidualFacts{7U, 4U, 32U, 234U},
    ResidualFacts{8U, 4U, 64U, 223U},
    ResidualFacts{10U, 4U, 119U, 203U},
    ResidualFacts{12U, 4U, 226U, 300U},
    ResidualFacts{14U, 4U, 374U, 216U},
    ResidualFacts{16U, 4U, 562U, 807U},
    ResidualFacts{20U, 4U, 1130U, 201U},
    ResidualFacts{24U, 4U, 2086U, 204U},
    ResidualFacts{28U, 4U, 3453U, 525U},
    ResidualFacts{32U, 4U, 5393U, 402U},
    ResidualFacts{40U, 4U, 12236U, 257U},
    ResidualFacts{48U, 4U, 25304U, 201U},
    ResidualFacts{56U, 4U, 48038U, 201U},
    ResidualFacts{64U, 4U, 83713U, 201U},
    ResidualFacts{96U, 4U, 438742U, 201U},
    ResidualFacts{128U, 4U, 1403925U, 213U},
    ResidualFacts{256U, 4U, 22541309U, 238U},
    ResidualFacts{512U, 4U, 357585719U, 201U},
    ResidualFacts{1024U, 4U, 5722070037U, 207U},
    ResidualFacts{2048U, 4U, 91597712219U, 201U},
    ResidualFacts{4093U, 4U, 1461591234300U, 201U},
    ResidualFacts{4096U, 2U, 16U, 201U},
};
static_assert(calc_fingerprint(kResidualFacts16) == 0x5E26C0D5U, "a row was changed; run facts.py");

/// Profiles 4, 8 and 44.
inline constexpr std::array kResidualFacts32{
    ResidualFacts{12U, 8U, 131U, 204U},
    ResidualFacts{16U, 8U, 836U, 204U},
    ResidualFacts{20U, 8U, 4694U, 204U},
    ResidualFacts{24U, 8U, 19428U, 241U},
    ResidualFacts{28U, 8U, 64696U, 228U},
    ResidualFacts{32U, 8U, 189888U, 221U},
    ResidualFacts{38U, 8U, 766055U, 204U},
    ResidualFacts{48U, 6U, 349U, 201U},
    ResidualFacts{56U, 6U, 2103U, 260U},
    ResidualFacts{64U, 6U, 7073U, 456U},
    ResidualFacts{96U, 6U, 116688U, 269U},
    ResidualFacts{128U, 6U, 707853U, 208U},
    ResidualFacts{256U, 6U, 47164999U, 214U},
    ResidualFacts{512U, 6U, 3045828262U, 202U},
    ResidualFacts{1024U, 6U, 195133888326U, 201U},
    ResidualFacts{2048U, 6U, 12500339567322U, 201U},
    ResidualFacts{4096U, 6U, 800373286599232U, 201U},
    ResidualFacts{8191U, 4U, 536625180U, 201U},
};
static_assert(calc_fingerprint(kResidualFacts32) == 0xF4FD7F5BU, "a row was changed; run facts.py");
// clang-format on

/// Errors of a frame with an 8-bit checksum, calculated exactly. The identifier that the counter picks makes
/// the profiles 1 (alternating), 2 and 22 not linear, so the four bits of the counter are followed one by
/// one.
struct ByteChecksumModel {
    std::uint8_t polynomial;
    std::size_t length;                      ///< of the frame [bytes]
    std::size_t crc_at;                      ///< [bytes]
    std::size_t counter_offset;              ///< [bits] as in NibbleCounterChannel
    std::uint32_t counter_max;               ///< greatest counter that is sent
    bool is_id_behind;                       ///< else in front of the frame
    std::array<std::uint8_t, 16U> data_ids;  ///< byte that goes into the checksum with each counter

    /// x times the remainder `power`.
    constexpr std::uint8_t shift(std::uint8_t power) const noexcept {
        const unsigned doubled = unsigned{power} << 1U;
        return static_cast<std::uint8_t>((power & 0x80U) != 0U ? doubled ^ polynomial : doubled);
    }
};

/// `sum` and those `syndromes` whose bits are set in `bits`.
template <std::size_t kCount>
constexpr std::uint8_t add_syndromes(std::uint32_t sum, const std::array<std::uint8_t, kCount>& syndromes,
                                     std::uint32_t bits) noexcept {
    for (std::size_t i = 0U; i < kCount; ++i) {
        sum ^= ((bits >> i) & 1U) != 0U ? syndromes[i] : 0U;
    }
    return static_cast<std::uint8_t>(sum);
}

/// How the bits outside the counter may add up: a sum of products of probabilities, nothing is subtracted.
class SyndromeDistribution final {
  public:
    explicit constexpr SyndromeDistribution(double turn) noexcept : turn_(turn), keep_(1.0 - turn) {}

    /// One more bit that may be turned. @param[in] syndrome not 0.
    constexpr void add_bit(std::uint8_t syndrome) noexcept {
        double* const turned = turned_.data();  // a compiler counts each call of an operator[]
        std::size_t lead = 0x80U;               // highest bit of the syndrome
        while (lead > 1U && (syndrome & lead) == 0U) {
            lead >>= 1U;
        }
        for (std::size_t begin = 0U; begin < turned_.size(); begin += 2U * lead) {
            for (std::size_t sum = begin; sum < begin + lead; ++sum) {
                const double here = turned[sum];
                const double there = turned[sum ^ syndrome];
                turned[sum] = keep_ * here + turn_ * there;
                turned[sum ^ syndrome] = keep_ * there + turn_ * here;
            }
        }
        turned[syndrome] += turn_ * untouched_;
        untouched_ *= keep_;
    }
    /// Probability that some bits are turned and add up to `sum`.
    constexpr double get_turned(std::uint8_t sum) const noexcept { return turned_[sum]; }
    /// Probability that they add up to `sum`, whether some are turned or none.
    constexpr double calc_any(std::uint8_t sum) const noexcept {
        return turned_[sum] + (sum == 0U ? untouched_ : 0.0);
    }

  private:
    double turn_;
    double keep_;
    double untouched_{1.0};
    std::array<double, 256U> turned_{};
};

/// Probability that exactly the four bits `turned` of a counter are turned.
constexpr double calc_nibble(std::uint32_t turned, double pe) noexcept {
    double result = 1.0;
    for (std::uint32_t bit = 0U; bit < 4U; ++bit) {
        result *= ((turned >> bit) & 1U) != 0U ? pe : 1.0 - pe;
    }
    return result;
}

/// Exact residual error with the counter for which it is greatest [1 per frame].
constexpr double calc_residual_error(const ByteChecksumModel& model, double pe) noexcept {
    SyndromeDistribution rest{pe};
    std::array<std::uint8_t, 4U> counter_bits{};
    std::array<std::uint8_t, 8U> id_bits{};
    std::uint8_t power = 1U;
    const auto take = [&power, &model]() noexcept {
        const std::uint8_t taken = power;
        power = model.shift(power);
        return taken;
    };
    const auto take_id = [&id_bits, &take]() noexcept {
        for (std::uint8_t& bit : id_bits) {
            bit = take();
        }
    };
    for (std::size_t bit = 0U; bit < 8U; ++bit) {
        rest.add_bit(take());  // the checksum itself
    }
    if (model.is_id_behind) {
        take_id();
    }
    for (std::size_t place = model.length; place-- > 0U;) {
        if (place == model.crc_at) {
            continue;
        }
        for (std::size_t bit = 0U; bit < 8U; ++bit) {
            const std::size_t into =
                place * 8U + bit - model.counter_offset;  // wraps in front of the counter
            if (into < counter_bits.size()) {
                counter_bits[into] = take();
            } else {
                rest.add_bit(take());
            }
        }
    }
    if (!model.is_id_behind) {
        take_id();
    }
    double worst = 0.0;
    for (std::uint32_t counter = 0U; counter <= model.counter_max; ++counter) {
        double sum = calc_nibble(0U, pe) * rest.get_turned(0U);
        for (std::uint32_t turned = 1U; turned < 16U; ++turned) {
            const std::uint8_t ids = model.data_ids[counter] ^ model.data_ids[counter ^ turned];
            const std::uint8_t needed = add_syndromes(add_syndromes(0U, counter_bits, turned), id_bits, ids);
            sum += calc_nibble(turned, pe) * rest.calc_any(needed);
        }
        worst = sum > worst ? sum : worst;
    }
    return worst;
}

constexpr double calc_power(double base, std::size_t exponent) noexcept {
    double result = 1.0;
    for (double square = base; exponent != 0U; exponent >>= 1U) {
        result *= (exponent & 1U) != 0U ? square : 1.0;
        square *= square;
    }
    return result;
}

/// Probability of one pattern of `turned` bits, the greatest of all bit error probabilities up to `pe`.
constexpr double bound_pattern(std::size_t bits, std::uint32_t turned, double pe) noexcept {
    const double peak = static_cast<double>(turned) / static_cast<double>(bits);
    const double worst = pe < peak ? pe : peak;
    return calc_power(worst, turned) * calc_power(1.0 - worst, bits - turned);
}

/// Probability that at least `turned` bits are turned, at most: ways to choose them times probability of a
/// way.
constexpr double bound_turned(std::size_t bits, std::uint32_t turned, double pe) noexcept {
    double bound = 1.0;
    for (std::uint32_t i = 0U; i < turned; ++i) {
        bound *= static_cast<double>(bits - i) * pe / static_cast<double>(i + 1U);
    }
    return bound < 1.0 ? bound : 1.0;
}

/// Bound for frames of `length` bytes, at most that of the row, from what is known of the row: what passes in
/// a shorter frame passes in a longer one with zeros in front. Of the patterns above the least weight at most
/// `share_hundredths` / 100 * 2^-width pass, if the bits are sound which the shorter frame lacks; those are
/// so with a probability of at least 1 - their number * pe.
template <std::size_t kWidth>
constexpr double bound_row(const ResidualFacts& row, std::size_t length, double pe) noexcept {
    const double sound = 1.0 - static_cast<double>((row.length - length) * 8U) * pe;
    if (sound <= 0.0) {
        return 1.0;
    }
    const double least = static_cast<double>(row.patterns) * bound_pattern(length * 8U, row.distance, pe);
    const double share = row.share_hundredths / 100.0 * calc_power(0.5, kWidth);
    const double more = share * bound_turned(row.length * 8U, row.distance + 1U, pe) / sound;
    return least + more < 1.0 ? least + more : 1.0;
}

/// Greatest bound of all lengths of a channel; 1 where a length is not known.
template <std::size_t kWidth>
constexpr double bound_lengths(Span<const ResidualFacts> rows, std::size_t length_min, std::size_t length_max,
                               double pe) noexcept {
    double worst = 0.0;
    std::size_t from = length_min;
    for (const ResidualFacts& row : rows) {
        if (row.length >= from) {
            const double bound = bound_row<kWidth>(row, from, pe);
            worst = bound > worst ? bound : worst;
            if (row.length >= length_max) {
                return worst;
            }
            from = row.length + 1U;
        }
    }
    return 1.0;
}

template <typename Profile>
constexpr double bound_channel(const NibbleCounterChannel& channel, double pe) noexcept {
    ByteChecksumModel model{kCrc8E2e.polynomial,
                            channel.length,
                            channel.crc_offset / 8U,
                            channel.counter_offset,
                            Profile::kCounterMax,
                            false,
                            {}};
    if (channel.mode == DataIdMode::kAlternating) {
        for (std::size_t counter = 0U; counter < model.data_ids.size(); ++counter) {
            model.data_ids[counter] =
                static_cast<std::uint8_t>(counter % 2U == 0U ? channel.data_id : channel.data_id >> 8U);
        }
    }
    return calc_residual_error(model, pe);
}

template <typename Profile>
constexpr double bound_channel(const IdListChannel& channel, double pe) noexcept {
    return calc_residual_error({kCrc8H2f.polynomial, channel.length, channel.offset,
                                (channel.offset + 1U) * 8U, Profile::kCounterMax, true, channel.data_ids},
                               pe);
}

template <typename Profile>
constexpr double bound_channel(const KnownIdChannel& channel, double pe) noexcept {
    return bound_lengths<16U>({kResidualFacts16.data(), kResidualFacts16.size()}, channel.length_min,
                              channel.length_max, pe);
}

template <typename Profile>
constexpr double bound_channel(const SentIdChannel& channel, double pe) noexcept {
    if constexpr (Profile::kNumber == 7U) {
        return calc_power(0.5, 64U);  // an estimate
    } else {
        return bound_lengths<32U>({kResidualFacts32.data(), kResidualFacts32.size()}, channel.length_min,
                                  channel.length_max, pe);
    }
}

}  // namespace detail

/// Probability that a frame arrives damaged and passes, at most [1 per frame].
/// Profiles 1, 2, 11, 22: exact, with the identifiers of the channel. 4, 5, 6, 8, 44: a bound that holds for
/// every smaller probability as well. 7: the usual estimate 2^-64, no proved bound. What the receiver
/// compares beside the checksum (length, identifier) is not counted in favour.
/// @param[in] channel a sound one. @param[in] pe bit error probability, above 0 and up to 0.5.
/// @return 1 for frames that are longer than what is known.
template <typename Profile>
constexpr double bound_residual_error(const typename Profile::Channel& channel, double pe) noexcept {
    return detail::bound_channel<Profile>(channel, pe);
}

}  // namespace mamori::safety

#endif  // MAMORI_SAFETY_E2E_RESIDUAL_ERROR_HPP
