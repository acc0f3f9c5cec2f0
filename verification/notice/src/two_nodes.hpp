// SPDX-License-Identifier: Apache-2.0
/// @file
/// Two systems in virtual time: one sends survival notices over a channel that delays and loses messages, the
/// other supervises it. A seeded sequence of injections is compared with what the supervisor reports.
///
/// @satisfies SWR-NTC-011      Design: docs/design/supervision.md#survival-notice
#ifndef MAMORI_VERIFICATION_NOTICE_TWO_NODES_HPP
#define MAMORI_VERIFICATION_NOTICE_TWO_NODES_HPP

#include <array>
#include <cstddef>
#include <cstdint>

namespace mamori::verification::notice {

/// What happens to the sending node.
enum class Injection : std::uint8_t {
    kKill,         ///< it stops and starts again with a new counter
    kFreeze,       ///< it stops and continues
    kCut,          ///< its channel loses all messages
    kHang,         ///< a component hangs
    kError,        ///< a component fails
    kExit,         ///< a component ends its life
    kStateChange,  ///< a component becomes inactive, then active again
};
inline constexpr std::size_t kInjectionCount = 7U;

/// Result of a run.
struct Outcome {
    std::uint64_t frames{0U};                                  ///< major frames of the supervising node
    std::array<std::uint32_t, kInjectionCount> injected{};     ///< by Injection
    std::uint32_t missed{0U};                                  ///< not reported within the bound
    std::uint32_t invented{0U};                                ///< faults that no injection explains
    std::array<std::int64_t, kInjectionCount> delay_max_ns{};  ///< from injection to report
    std::uint64_t sent{0U};                                    ///< messages
    std::uint64_t lost{0U};  ///< of these, by the channel within its tolerance
};

/// Bound of a node that sends nothing and of a change in a notice, as the manual derives it.
inline constexpr std::int64_t kSilenceBoundNs = 23'000'000;
inline constexpr std::int64_t kChangeBoundNs = 17'000'000;

/// @param[in] frames major frames of 1 ms. @param[in] injections spread over them; 0: none.
Outcome run_two_nodes(std::uint64_t frames, std::uint32_t injections, std::uint32_t seed);

}  // namespace mamori::verification::notice

#endif  // MAMORI_VERIFICATION_NOTICE_TWO_NODES_HPP
