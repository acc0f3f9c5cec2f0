// SPDX-License-Identifier: Apache-2.0
/// @file
/// What a reading of a protected input gives and what became of it, and the judgement of an age.
///
/// @satisfies SWR-E2E-034, SWR-E2E-035      Design: docs/design/e2e.md#ports
#ifndef MAMORI_SAFETY_E2E_PORT_OUTCOME_HPP
#define MAMORI_SAFETY_E2E_PORT_OUTCOME_HPP

#include <array>
#include <cstddef>
#include <cstdint>

#include "mamori/kernel/base/time.hpp"

namespace mamori::safety {

/// What a reading handed out.
enum class E2eWorth : std::uint8_t {
    kSubstitute,  ///< the fail-safe substitute: no value may be used now
    kHeld,        ///< the value that was accepted last, still young enough; this reading brought none
    kNew,         ///< the value of a frame that was accepted in this reading
};

/// What became of a reading. Exactly one per reading; the worst where several would do.
enum class E2eOutcome : std::uint8_t {
    kAccepted,   ///< its value was handed out
    kSilent,     ///< no frame
    kRefused,    ///< by the check of the frame, whose cause tells more
    kMalformed,  ///< a good frame whose content is no value of the type: the ends disagree on the message
    kEarly,      ///< from an instant to come, beyond the tolerance: the message waits for the next reading;
                 ///< early again, or after one that waited, it is rejected: the ends disagree on the time
    kLate,       ///< older than the limit
    kUnproven,   ///< a good value, while the channel is not valid
};
inline constexpr std::size_t kE2eOutcomeCount = 7U;

/// How often each outcome came since the start.
using E2eOutcomeCounts = std::array<std::uint32_t, kE2eOutcomeCount>;

/// Judges an age without overflow, whatever the instants are: one of them may come from another program.
/// @param[in] age_max >= 0. @param[in] lead_max how far `origin` may be after `now`, >= 0.
/// @return kAccepted, kEarly or kLate.
constexpr E2eOutcome judge_age(Instant origin, Instant now, Duration age_max,
                               Duration lead_max = {}) noexcept {
    if (origin > now) {
        const std::uint64_t lead_ns =
            static_cast<std::uint64_t>(origin.ns) - static_cast<std::uint64_t>(now.ns);
        return lead_ns > static_cast<std::uint64_t>(lead_max.ns) ? E2eOutcome::kEarly : E2eOutcome::kAccepted;
    }
    // Two's complement: right for each pair of instants of which the first is not the later one.
    const std::uint64_t age_ns = static_cast<std::uint64_t>(now.ns) - static_cast<std::uint64_t>(origin.ns);
    return age_ns > static_cast<std::uint64_t>(age_max.ns) ? E2eOutcome::kLate : E2eOutcome::kAccepted;
}

/// Spelling for logs and reports; "Invalid" for a corrupted value, never nullptr.
constexpr const char* get_name(E2eWorth worth) noexcept {
    switch (worth) {
        case E2eWorth::kSubstitute:
            return "Substitute";
        case E2eWorth::kHeld:
            return "Held";
        case E2eWorth::kNew:
            return "New";
    }
    return "Invalid";
}
constexpr const char* get_name(E2eOutcome outcome) noexcept {
    switch (outcome) {
        case E2eOutcome::kAccepted:
            return "Accepted";
        case E2eOutcome::kSilent:
            return "Silent";
        case E2eOutcome::kRefused:
            return "Refused";
        case E2eOutcome::kMalformed:
            return "Malformed";
        case E2eOutcome::kEarly:
            return "Early";
        case E2eOutcome::kLate:
            return "Late";
        case E2eOutcome::kUnproven:
            return "Unproven";
    }
    return "Invalid";
}

}  // namespace mamori::safety

#endif  // MAMORI_SAFETY_E2E_PORT_OUTCOME_HPP
