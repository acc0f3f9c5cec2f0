// SPDX-License-Identifier: Apache-2.0
/// @file
/// Voters over two and three channels: 1oo2, where either channel is enough to demand the safe state, and
/// 2oo3, which also names the channel that deviates and goes on as 1oo2 without it.
///
/// @satisfies SWR-RED-003, SWR-RED-005, SWR-RED-006      Design: docs/design/redundancy.md#voters
/// Source:   IEC 61508-6:2010 annex B (MooN architectures); IEC 61508-7:2010 A.1.4 (majority voter)
#ifndef MAMORI_SAFETY_REDUNDANCY_VOTER_HPP
#define MAMORI_SAFETY_REDUNDANCY_VOTER_HPP

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "mamori/kernel/base/assert.hpp"
#include "mamori/kernel/base/status.hpp"
#include "mamori/kernel/base/time.hpp"
#include "mamori/safety/redundancy/discrepancy.hpp"

namespace mamori::safety {

/// Which of two values is the worse one, so that acting on it is safe.
enum class WorseValue : std::uint8_t {
    kGreater,
    kSmaller,
    kFurtherFromZero,
    kNone,  ///< neither is: channels that disagree give no value at all
};

/// @return the worse one of two numbers; `a` when none is worse.
constexpr double choose_worse(double a, double b, WorseValue worse) noexcept {
    const double distance_a = a < 0.0 ? -a : a;
    const double distance_b = b < 0.0 ? -b : b;
    switch (worse) {
        case WorseValue::kGreater:
            return a < b ? b : a;
        case WorseValue::kSmaller:
            return b < a ? b : a;
        case WorseValue::kFurtherFromZero:
            return distance_a < distance_b ? b : a;
        case WorseValue::kNone:
            return a;
    }
    return a;  // a corrupted order is refused by is_valid()
}

/// What a voter over values holds its channels against.
struct VoterLimits {
    double tolerance{0.0};         ///< absolute, in the unit of the values: finite, >= 0
    Duration discrepancy_time{0};  ///< for which a disagreement is tolerated, included: >= 0
    WorseValue worse{WorseValue::kNone};
};

/// True when the limits are inside their range. The discrepancy time is judged by its timer.
constexpr bool is_valid(const VoterLimits& limits) noexcept {
    return is_tolerance(limits.tolerance) && limits.worse <= WorseValue::kNone;
}

/// Votes over measured values.
///
/// Thread safety: none; call step() once per cycle. Time: O(channels), nothing blocks. Memory: no heap.
/// @tparam kChannels 2 (1oo2) or 3 (2oo3).
template <std::size_t kChannels>
class ValueVoter final {
    static_assert(kChannels == 2U || kChannels == 3U, "1oo2 and 2oo3 are the votes there are");

  public:
    using Values = std::array<double, kChannels>;

    explicit constexpr ValueVoter(const VoterLimits& limits) noexcept
        : ValueVoter(limits, std::make_index_sequence<kChannels>{}) {}

    /// Votes once. Channels that agree with another one are the majority; what others say has no influence.
    /// @param[in] values of one moment; a channel without a value says not-a-number.
    /// @return median of three that agree, the worse one of two that agree; without a majority the worst of
    ///         all channels that are not lost, within the discrepancy time; kError (no value can be trusted:
    ///         stop) when there is no worse one, one of them is not finite, or the time is over.
    Result<double> step(const Values& values, Instant now) noexcept;

    /// Takes lost channels back, and forgets a vote that failed. Only for a deliberate act of a person.
    /// @return kOk (nothing is latched now); kPreconditionNotMet (what a majority contradicted in the last
    ///         step, or a vote without a majority, stays latched).
    Status acknowledge() noexcept;

    /// @return judgement about the vote as a whole: whether there was a majority.
    constexpr Discrepancy get_discrepancy() const noexcept { return vote_.get(); }
    /// @param[in] channel 0 .. kChannels - 1. @return judgement about one channel, kLatched when it is lost.
    ///         Of two channels that disagree nobody can say which one deviates: both stay kNone.
    constexpr Discrepancy get_discrepancy(std::size_t channel) const noexcept {
        MAMORI_REQUIRE(2, channel < kChannels);
        return channels_[channel].get();
    }

  private:
    struct Ballot {
        Values values{};
        std::size_t count{0U};
        void add(double value) noexcept {
            values[count] = value;
            ++count;
        }
    };

    bool is_lost(std::size_t channel) const noexcept {
        return channels_[channel].get() == Discrepancy::kLatched;
    }
    bool agrees_with_another(const Values& values, std::size_t channel) const noexcept;
    double calc_majority(const Ballot& majority) const noexcept;
    Result<double> calc_worst(const Ballot& voting) const noexcept;

    template <std::size_t... kIndex>
    constexpr ValueVoter(const VoterLimits& limits, std::index_sequence<kIndex...> /*channels*/) noexcept
        : limits_(limits),
          vote_(limits.discrepancy_time),
          channels_{{(static_cast<void>(kIndex), DiscrepancyTimer(limits.discrepancy_time))...}} {
        MAMORI_REQUIRE(1, is_valid(limits));
    }

    VoterLimits limits_;
    DiscrepancyTimer vote_;
    std::array<DiscrepancyTimer, kChannels> channels_;
};

template <std::size_t kChannels>
bool ValueVoter<kChannels>::agrees_with_another(const Values& values, std::size_t channel) const noexcept {
    bool does_agree = false;
    for (std::size_t other = 0U; other < kChannels; ++other) {
        if (other != channel && !is_lost(other)) {
            does_agree = does_agree || agree(values[channel], values[other], limits_.tolerance);
        }
    }
    return does_agree;
}

template <std::size_t kChannels>
double ValueVoter<kChannels>::calc_majority(const Ballot& majority) const noexcept {
    const double a = majority.values[0];
    const double b = majority.values[1];
    if constexpr (kChannels == 3U) {
        if (majority.count == kChannels) {
            const double low = choose_worse(a, b, WorseValue::kSmaller);
            const double high = choose_worse(a, b, WorseValue::kGreater);
            const double below_high = choose_worse(high, majority.values[2], WorseValue::kSmaller);
            return choose_worse(low, below_high, WorseValue::kGreater);
        }
    }
    return choose_worse(a, b, limits_.worse);
}

template <std::size_t kChannels>
Result<double> ValueVoter<kChannels>::calc_worst(const Ballot& voting) const noexcept {
    if (limits_.worse == WorseValue::kNone) {
        return Status::kError;
    }
    double worst = voting.values[0];
    bool can_vote = voting.count >= 2U;  // always: a channel is lost by a majority, which two cannot lose
    for (std::size_t i = 0U; i < voting.count; ++i) {
        can_vote = can_vote && agree(voting.values[i], voting.values[i], 0.0);
        worst = choose_worse(worst, voting.values[i], limits_.worse);
    }
    if (!can_vote) {
        return Status::kError;
    }
    return worst;
}

template <std::size_t kChannels>
Result<double> ValueVoter<kChannels>::step(const Values& values, Instant now) noexcept {
    std::array<bool, kChannels> does_agree{};
    Ballot voting{};    // channels that are not lost
    Ballot majority{};  // those of them that agree with another one
    for (std::size_t channel = 0U; channel < kChannels; ++channel) {
        does_agree[channel] = agrees_with_another(values, channel);
        if (!is_lost(channel)) {
            voting.add(values[channel]);
            if (does_agree[channel]) {
                majority.add(values[channel]);
            }
        }
    }
    // Without a majority nobody knows which channel deviates, so none is named.
    const bool has_majority = majority.count != 0U;
    for (std::size_t channel = 0U; channel < kChannels; ++channel) {
        static_cast<void>(channels_[channel].step(has_majority && !does_agree[channel], now));
    }
    if (vote_.step(!has_majority, now) == Discrepancy::kLatched) {
        return Status::kError;
    }
    if (has_majority) {
        return calc_majority(majority);
    }
    return calc_worst(voting);
}

template <std::size_t kChannels>
Status ValueVoter<kChannels>::acknowledge() noexcept {
    Status result = vote_.acknowledge();
    for (DiscrepancyTimer& channel : channels_) {
        if (channel.acknowledge() != Status::kOk) {
            result = Status::kPreconditionNotMet;
        }
    }
    return result;
}

using ValueVoter1oo2 = ValueVoter<2U>;
using ValueVoter2oo3 = ValueVoter<3U>;

/// Votes over demands for the safe state: a ValueVoter over 0 and 1, where 1 is the worse one.
///
/// Thread safety: none; call step() once per cycle. Time: O(channels), nothing blocks. Memory: no heap.
/// @tparam kChannels 2 (1oo2: either demands) or 3 (2oo3: two demand; without a lost channel either of two).
template <std::size_t kChannels>
class DemandVoter final {
  public:
    using Demands = std::array<bool, kChannels>;

    /// @param[in] discrepancy_time for which channels may differ, included: >= 0.
    explicit constexpr DemandVoter(Duration discrepancy_time) noexcept
        : voter_({0.0, discrepancy_time, WorseValue::kGreater}) {}

    /// @return true when the safe state is demanded: by the vote, or because the vote failed.
    [[nodiscard]] bool step(const Demands& demands, Instant now) noexcept {
        typename ValueVoter<kChannels>::Values values{};
        for (std::size_t channel = 0U; channel < kChannels; ++channel) {
            values[channel] = demands[channel] ? 1.0 : 0.0;
        }
        const Result<double> vote = voter_.step(values, now);
        return !vote.has_value() || vote.get_value() > 0.0;
    }

    /// As that of ValueVoter.
    Status acknowledge() noexcept { return voter_.acknowledge(); }
    constexpr Discrepancy get_discrepancy() const noexcept { return voter_.get_discrepancy(); }
    constexpr Discrepancy get_discrepancy(std::size_t channel) const noexcept {
        return voter_.get_discrepancy(channel);
    }

  private:
    ValueVoter<kChannels> voter_;
};

using DemandVoter1oo2 = DemandVoter<2U>;
using DemandVoter2oo3 = DemandVoter<3U>;

}  // namespace mamori::safety

#endif  // MAMORI_SAFETY_REDUNDANCY_VOTER_HPP
