// SPDX-License-Identifier: Apache-2.0
/// @file
/// How many damaged frames of a channel pass in an hour, and the proof that they are within a budget: a
/// channel over its budget does not compile.
///
/// @satisfies SWR-E2E-024      Design: docs/design/e2e.md#residual-error
/// Source:   IEC 61784-3 (rate of residual errors, share of a channel)
#ifndef MAMORI_SAFETY_E2E_CHANNEL_BUDGET_HPP
#define MAMORI_SAFETY_E2E_CHANNEL_BUDGET_HPP

#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "mamori/safety/e2e/channel.hpp"
#include "mamori/safety/e2e/residual_error.hpp"

namespace mamori::safety {

// Residual errors that one channel may have: 1 % of the upper end of the band of its safety integrity level
// [1/h].
inline constexpr double kSil1ChannelBudget = 1e-7;
inline constexpr double kSil2ChannelBudget = 1e-8;
inline constexpr double kSil3ChannelBudget = 1e-9;
inline constexpr double kSil4ChannelBudget = 1e-10;

/// What a channel is used for, and what it may cost.
struct ChannelUse {
    double rate_hz{0.0};                         ///< frames [1/s], above 0
    double bit_error_probability{1e-2};          ///< above 0 and up to 0.5; below 1e-2 with an argument only
    std::uint32_t receivers{1U};                 ///< from 1 on; an error at any of them counts
    double budget_per_hour{kSil3ChannelBudget};  ///< above 0
};

/// Why a channel is not within its budget.
enum class BudgetFault : std::uint8_t {
    kNone,
    kChannel,        ///< the channel itself is not sound, see is_sound()
    kUse,            ///< rate, probability, receivers or budget out of range
    kShortDistance,  ///< profile 2 or 22 with more than 14 bytes: two turned bits may pass
    kUnknownLength,  ///< longer than the frames whose residual error is known
    kBudget,         ///< more residual errors in an hour than the budget allows
};

namespace detail {

constexpr std::size_t get_longest(const NibbleCounterChannel& channel) noexcept {
    return channel.length;
}
constexpr std::size_t get_longest(const IdListChannel& channel) noexcept {
    return channel.length;
}
constexpr std::size_t get_longest(const KnownIdChannel& channel) noexcept {
    return channel.length_max;
}
constexpr std::size_t get_longest(const SentIdChannel& channel) noexcept {
    return channel.length_max;
}

/// Longest frame for which more is known than that errors may pass [bytes].
template <typename Profile>
constexpr std::size_t get_longest_known() noexcept {
    if constexpr (Profile::kNumber == 4U || Profile::kNumber == 8U || Profile::kNumber == 44U) {
        return kResidualFacts32.back().length;
    } else {
        return Profile::kLengthMax;
    }
}

}  // namespace detail

/// Damaged frames that pass in an hour, at most [1/h]. @param[in] channel, use without faults.
template <typename Profile>
constexpr double bound_residual_rate(const typename Profile::Channel& channel,
                                     const ChannelUse& use) noexcept {
    constexpr double kSecondsPerHour = 3600.0;
    return bound_residual_error<Profile>(channel, use.bit_error_probability) * use.rate_hz * kSecondsPerHour *
           use.receivers;
}

/// @return true with all values of `use` in their ranges; a value that is no number is in none.
constexpr bool is_use_sound(const ChannelUse& use) noexcept {
    if (!(use.rate_hz > 0.0) || use.receivers == 0U) {
        return false;
    }
    if (!(use.bit_error_probability > 0.0) || !(use.bit_error_probability <= 0.5)) {
        return false;
    }
    return use.budget_per_hour > 0.0;
}

/// What is wrong with a channel and its use.
struct BudgetVerdict {
    BudgetFault fault;
    std::uint64_t times;  ///< kBudget: so often the budget goes into the rate, rounded up; stops at 1e9
};

/// @return the first fault that is true, in the order of BudgetFault.
template <typename Profile>
constexpr BudgetVerdict judge_budget(const typename Profile::Channel& channel,
                                     const ChannelUse& use) noexcept {
    constexpr std::size_t kLongestWithDistance = 14U;
    constexpr double kMostTimes = 1e9;
    if (Profile::find_fault(channel) != ChannelFault::kNone) {
        return {BudgetFault::kChannel, 0U};
    }
    if (!is_use_sound(use)) {
        return {BudgetFault::kUse, 0U};
    }
    if constexpr (std::is_same_v<typename Profile::Channel, IdListChannel>) {
        if (channel.length > kLongestWithDistance) {
            return {BudgetFault::kShortDistance, 0U};
        }
    }
    if (detail::get_longest(channel) > detail::get_longest_known<Profile>()) {
        return {BudgetFault::kUnknownLength, 0U};
    }
    const double rate = bound_residual_rate<Profile>(channel, use);
    if (rate <= use.budget_per_hour) {
        return {BudgetFault::kNone, 0U};
    }
    const double times = rate / use.budget_per_hour;
    return {BudgetFault::kBudget, 1U + static_cast<std::uint64_t>(times < kMostTimes ? times : kMostTimes)};
}

/// Fails to compile for a fault; the compiler prints it, and how many times the budget is exceeded.
template <BudgetFault kFault, std::uint64_t kTimesOfBudget>
struct ChannelIsWithinBudget : std::true_type {
    static_assert(kFault != BudgetFault::kChannel,
                  "channel is not sound; static_assert(is_sound<...>()) says why");
    static_assert(kFault != BudgetFault::kUse,
                  "use of the channel is out of range; give rate_hz > 0, 0 < bit_error_probability <= 0.5, "
                  "receivers >= 1 and budget_per_hour > 0");
    static_assert(kFault != BudgetFault::kShortDistance,
                  "two turned bits may pass in profile 2 or 22 above 14 bytes; send at most 14 bytes or take "
                  "another profile");
    static_assert(kFault != BudgetFault::kUnknownLength,
                  "residual error of frames this long is not known; send shorter frames or take profile 7");
    static_assert(
        kFault != BudgetFault::kBudget,
        "residual error rate exceeds the budget; send shorter or fewer frames, take profile 4 or 7, "
        "or argue a lower bit error probability (./mamori e2e shows the exact rate)");
};

/// Proves a channel where a table is made: static_assert(is_within_budget<E2eProfile04<>, kChannel, kUse>());
/// @tparam kChannel, kUse constexpr channel of the profile and ChannelUse, of static storage duration.
/// @return true; every other outcome does not compile.
template <typename Profile, const auto& kChannel, const auto& kUse>
constexpr bool is_within_budget() noexcept {
    constexpr BudgetVerdict kVerdict = judge_budget<Profile>(kChannel, kUse);
    return ChannelIsWithinBudget<kVerdict.fault, kVerdict.times>::value;
}

}  // namespace mamori::safety

#endif  // MAMORI_SAFETY_E2E_CHANNEL_BUDGET_HPP
