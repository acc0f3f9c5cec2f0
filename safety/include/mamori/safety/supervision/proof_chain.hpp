// SPDX-License-Identifier: Apache-2.0
/// @file
/// Turns the question of a watchdog into its answer, link by link: each part of the supervision adds one when
/// it has done its work and found nothing. A part that was skipped, doubled, moved, or that found something
/// leads to another answer.
///
/// @satisfies SWR-SUP-039      Design: docs/design/supervision.md#proof-chain
#ifndef MAMORI_SAFETY_SUPERVISION_PROOF_CHAIN_HPP
#define MAMORI_SAFETY_SUPERVISION_PROOF_CHAIN_HPP

#include <cstddef>
#include <cstdint>

#include "mamori/kernel/base/crc32.hpp"
#include "mamori/safety/supervision/supervision_table.hpp"

namespace mamori::safety {

/// What a link stands for.
enum class ProofLink : std::uint8_t {
    kReports = 1U,     ///< the reports of an entity were taken and judged
    kAlive = 2U,       ///< an alive supervision ended its cycle
    kDeadline = 3U,    ///< a deadline was held against the time
    kEntity = 4U,      ///< the local status of an entity was formed
    kWhole = 5U,       ///< the global status was formed
    kApplication = 6U  ///< a part of the application, beyond the supervision
};

/// A running checksum over the question and the links.
///
/// Thread safety: none. Time: O(1) for each link. Memory: four bytes, and the table of the CRC.
class ProofChain final {
  public:
    /// @param[in] question as the device has posed it.
    constexpr explicit ProofChain(std::uint32_t question) noexcept { add_word(question); }

    /// @param[in] index of the part, 0 .. 65535.
    /// @param[in] deviation how its state differs from the wanted one, 0 .. 255; only 0 is right.
    constexpr void add(ProofLink link, std::size_t index, std::uint8_t deviation = 0U) noexcept {
        add_word(static_cast<std::uint32_t>(link) << 24U | std::uint32_t{deviation} << 16U |
                 (static_cast<std::uint32_t>(index) & 0xFFFFU));
    }

    /// The answer.
    constexpr std::uint32_t get_value() const noexcept { return crc_.get_value(); }

  private:
    constexpr void add_word(std::uint32_t word) noexcept {
        for (std::uint32_t shift = 0U; shift < 32U; shift += 8U) {
            crc_.add(static_cast<std::uint8_t>(word >> shift & 0xFFU));
        }
    }

    Crc32 crc_{};
};

/// Adds what a supervision of this table adds in a cycle in which nothing is wrong, whatever its mode.
constexpr void add_sound_cycle(ProofChain& chain, const SupervisionTable& table) noexcept {
    for (std::size_t e = 0U; e < table.entities.size(); ++e) {
        chain.add(ProofLink::kReports, e);
    }
    for (std::size_t i = 0U; i < table.alives.size(); ++i) {
        chain.add(ProofLink::kAlive, i);
    }
    for (std::size_t i = 0U; i < table.deadlines.size(); ++i) {
        chain.add(ProofLink::kDeadline, i);
    }
    for (std::size_t e = 0U; e < table.entities.size(); ++e) {
        chain.add(ProofLink::kEntity, e);
    }
    chain.add(ProofLink::kWhole, 0U);
}

/// The right answer to a question, for the device: not to be linked into the software that is watched.
constexpr std::uint32_t calc_sound_answer(const SupervisionTable& table, std::uint32_t question) noexcept {
    ProofChain chain{question};
    add_sound_cycle(chain, table);
    return chain.get_value();
}

}  // namespace mamori::safety

#endif  // MAMORI_SAFETY_SUPERVISION_PROOF_CHAIN_HPP
