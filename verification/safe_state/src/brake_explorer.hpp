// SPDX-License-Identifier: Apache-2.0
/// @file
/// Calls the compiled functions of a brake sequence in every reachable situation, in any order, and records
/// their results: the complete relation of the sequence, from which models for provers are created.
///
/// @satisfies SWR-FSM-032, SWR-FSM-033      Design: docs/design/safe_state.md#brakes-in-the-models
#ifndef MAMORI_VERIFICATION_SAFE_STATE_BRAKE_EXPLORER_HPP
#define MAMORI_VERIFICATION_SAFE_STATE_BRAKE_EXPLORER_HPP

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <map>
#include <optional>
#include <stdexcept>
#include <type_traits>
#include <utility>
#include <vector>

#include "mamori/safety/reaction/brake_sequence.hpp"

namespace mamori::verification {

using safety::BrakeLimits;
using safety::SafeState;
using safety::StopOutputs;

/// Classes of the time since the command to close: before it, within the closing time, at it, beyond it.
enum class ClosingTime : std::uint8_t { kBeforeCommand, kWithin, kAtBound, kBeyond };
inline constexpr std::size_t kClosingTimeCount = 4U;

/// The states, and one that represents invalid numbers.
inline constexpr std::size_t kCallStateCount = safety::kSafeStateCount + 1U;

/// Letters of the calls; the time is the last digit, preceded by state, standstill and contacts.
inline constexpr std::size_t kConfirmLetters = kCallStateCount * 4U * kClosingTimeCount;
inline constexpr std::size_t kApplyLetters = kCallStateCount * kClosingTimeCount;

/// Results of a call, except the time of the command, which `is_told_now` represents.
struct CallAnswer {
    bool is_confirmed{false};  ///< confirm() only
    StopOutputs outputs{};     ///< apply() only
    bool is_told_now{false};   ///< the command to close counts from this call on
    std::size_t next{0U};      ///< situation after the call
};

inline bool operator==(const CallAnswer& a, const CallAnswer& b) {
    return a.is_confirmed == b.is_confirmed && a.outputs == b.outputs && a.is_told_now == b.is_told_now &&
           a.next == b.next;
}

/// A situation of the sequence: its complete memory, except the time of the command to close.
struct BrakeSituation {
    std::vector<CallAnswer> confirm;
    std::vector<CallAnswer> apply;
    std::array<bool, kClosingTimeCount> is_overdue{};
    std::array<bool, kClosingTimeCount> is_closing{};
};

inline bool operator==(const BrakeSituation& a, const BrakeSituation& b) {
    return a.confirm == b.confirm && a.apply == b.apply && a.is_overdue == b.is_overdue &&
           a.is_closing == b.is_closing;
}

/// The behaviour of the sequence. Situation 0 is that after power-up with contacts.
struct BrakeRelation {
    std::vector<BrakeSituation> situations;
    std::size_t first_without_contacts{0U};
    std::uint64_t calls{0U};  ///< of compiled functions
};

/// Explores one sequence with one closing time, with contacts and without.
/// @tparam Sequence BrakeSequence, or a class with its interface.
template <typename Sequence>
class BrakeExplorer final {
    static_assert(std::is_trivially_copyable_v<Sequence>, "situations are compared by their bytes");

  public:
    /// @param[in] closes_within >= 2, so that a time later than the command is within it.
    /// @param[in] invalid       number that represents all invalid states.
    BrakeExplorer(Duration closes_within, std::uint8_t invalid)
        : closes_within_(closes_within),
          invalid_(invalid),
          sequences_{Sequence{{closes_within, true}}, Sequence{{closes_within, false}}},
          sequence_(sequences_.front()) {
        find_command_time();
        const std::int64_t bound = closes_within.ns;
        elapsed_ = {-kFar, -1, 1, bound - 1, bound, bound + 1, kFar, 0};
    }

    /// @return all situations that are reachable from power-up by calls.
    /// @throw std::runtime_error if the sequence depends on time in another way than by its closing time, or
    /// has more than kSituationsMax situations.
    const BrakeRelation& explore() {
        static_cast<void>(find_or_add(copy(sequences_[0])));
        explore_from(0U);
        relation_.first_without_contacts = find_or_add(copy(sequences_[1]));
        explore_from(relation_.first_without_contacts);
        return relation_;
    }

    static constexpr std::size_t kSituationsMax = 400U;

  private:
    using Image = std::array<unsigned char, sizeof(Sequence)>;
    using Answers = std::array<std::optional<CallAnswer>, kClosingTimeCount>;

    static constexpr std::int64_t kFar = 1'000'000'000'000'000;           // eleven days
    static constexpr std::int64_t kLateBase = 4'000'000'000'000'000'000;  // the year 2096
    static constexpr std::array<std::int64_t, 2U> kBases{0, kLateBase};   // times of the command

    static Image copy(const Sequence& sequence) {
        Image image{};
        std::memcpy(image.data(), &sequence, image.size());
        return image;
    }

    /// The only working object: bytes between its members keep their values, unlike those of a local copy.
    Sequence& load(const Image& image) {
        std::memcpy(static_cast<void*>(&sequence_), image.data(), image.size());
        return sequence_;
    }

    SafeState get_call_state(std::size_t digit) const {
        const bool is_state = digit < safety::kSafeStateCount;
        return static_cast<SafeState>(is_state ? digit + 1U : invalid_);
    }

    /// Finds the bytes that hold the time of the command: those that differ between commands at 0 and at -1.
    void find_command_time() {
        const Image fresh = copy(sequences_[0]);
        std::array<Image, 2U> images{};
        for (std::size_t i = 0U; i < images.size(); ++i) {
            Sequence& sequence = load(fresh);
            static_cast<void>(sequence.apply(SafeState::kSafe, Instant{i == 0U ? 0 : -1}));
            images[i] = copy(sequence);
        }
        std::size_t count = 0U;
        for (std::size_t i = 0U; i < sizeof(Sequence); ++i) {
            if (images[0][i] != images[1][i]) {
                command_time_at_ = count == 0U ? i : command_time_at_;
                ++count;
            }
        }
        if (count != sizeof(Instant)) {
            throw std::runtime_error("the sequence keeps its command in another way than as one instant");
        }
    }

    Image with_command(const Image& image, std::int64_t at) const {
        Image moved = image;
        std::memcpy(moved.data() + command_time_at_, &at, sizeof(at));
        return moved;
    }

    std::int64_t get_command(const Image& image) const {
        std::int64_t at = 0;
        std::memcpy(&at, image.data() + command_time_at_, sizeof(at));
        return at;
    }

    std::size_t find_or_add(const Image& image) {
        const auto [place, is_new] = numbers_.insert({image, images_.size()});
        if (is_new) {
            if (images_.size() == kSituationsMax) {
                throw std::runtime_error("the sequence has no end of situations");
            }
            images_.push_back(image);
            relation_.situations.emplace_back();
        }
        return place->second;
    }

    void explore_from(std::size_t first) {
        for (std::size_t i = first; i < images_.size(); ++i) {
            BrakeSituation situation;
            for (std::size_t letter = 0U; letter < kCallStateCount * 4U; ++letter) {
                const SafeState state = get_call_state(letter / 4U);
                const bool is_standing = (letter & 2U) != 0U;
                const bool are_closed = (letter & 1U) != 0U;
                add_answers(i, situation.confirm, [=](Sequence& sequence, Instant now, CallAnswer& answer) {
                    answer.is_confirmed = sequence.confirm(state, is_standing, are_closed, now);
                });
            }
            for (std::size_t letter = 0U; letter < kCallStateCount; ++letter) {
                const SafeState state = get_call_state(letter);
                add_answers(i, situation.apply, [=](Sequence& sequence, Instant now, CallAnswer& answer) {
                    answer.outputs = sequence.apply(state, now);
                });
            }
            situation.is_overdue = ask(
                images_[i], [](const Sequence& sequence, Instant now) { return sequence.is_overdue(now); });
            situation.is_closing = ask(
                images_[i], [](const Sequence& sequence, Instant now) { return sequence.is_closing(now); });
            relation_.situations[i] = situation;
        }
    }

    ClosingTime classify(std::int64_t elapsed) const {
        if (elapsed < 0) {
            return ClosingTime::kBeforeCommand;
        }
        return elapsed < closes_within_.ns    ? ClosingTime::kWithin
               : elapsed == closes_within_.ns ? ClosingTime::kAtBound
                                              : ClosingTime::kBeyond;
    }

    /// Appends one result per class of times, equal for all times of a class.
    template <typename Call>
    void add_answers(std::size_t number, std::vector<CallAnswer>& list, Call call) {
        const Image image = images_[number];  // a copy: the list grows meanwhile
        Answers answers;
        for (const std::int64_t elapsed : elapsed_) {
            for (const std::int64_t base : kBases) {
                note(classify(elapsed), make_call(image, base, elapsed, call), elapsed == 0, answers);
            }
        }
        for (const auto& answer : answers) {
            list.push_back(answer.value());
        }
    }

    template <typename Call>
    CallAnswer make_call(const Image& image, std::int64_t base, std::int64_t elapsed, Call call) {
        Sequence& sequence = load(with_command(image, base));
        const Instant now{base + elapsed};
        CallAnswer answer;
        call(sequence, now, answer);
        ++relation_.calls;
        const Image after = copy(sequence);
        const std::int64_t told_at = get_command(after);
        if (told_at != base && told_at != now.ns) {
            throw std::runtime_error(
                "a call keeps another time of the command than its own or the one before");
        }
        answer.is_told_now = told_at != base;
        answer.next = find_or_add(with_command(after, 0));
        return answer;
    }

    /// @param[in] is_at_command the call comes at the time of the previous command, where a new command is
    /// indistinguishable from the old one. Used after the other calls of its class.
    static void note(ClosingTime time, CallAnswer answer, bool is_at_command, Answers& answers) {
        std::optional<CallAnswer>& known = answers[static_cast<std::size_t>(time)];
        if (is_at_command && known.has_value()) {
            answer.is_told_now = known->is_told_now;
        }
        if (!(known.value_or(answer) == answer)) {
            throw std::runtime_error("the sequence depends on time in another way than by its closing time");
        }
        known = answer;
    }

    /// @return the result of a const function in each class of times.
    template <typename Question>
    std::array<bool, kClosingTimeCount> ask(const Image& image, Question question) {
        std::array<std::optional<bool>, kClosingTimeCount> answers;
        for (const std::int64_t elapsed : elapsed_) {
            for (const std::int64_t base : kBases) {
                const Sequence& sequence = load(with_command(image, base));
                const bool answer = question(sequence, Instant{base + elapsed});
                ++relation_.calls;
                std::optional<bool>& known = answers[static_cast<std::size_t>(classify(elapsed))];
                if (known.value_or(answer) != answer) {
                    throw std::runtime_error(
                        "what is overdue or closing depends on more than the closing time");
                }
                known = answer;
            }
        }
        return {answers[0].value(), answers[1].value(), answers[2].value(), answers[3].value()};
    }

    Duration closes_within_;
    std::uint8_t invalid_;
    std::array<Sequence, 2U> sequences_;
    Sequence sequence_;
    std::vector<std::int64_t> elapsed_;
    std::size_t command_time_at_{0U};
    std::map<Image, std::size_t> numbers_;
    std::vector<Image> images_;
    BrakeRelation relation_;
};

/// Explores with several closing times and several invalid numbers.
/// @return the relation, which is equal for all of them.
/// @throw std::runtime_error if the relations differ, and the errors of BrakeExplorer.
template <typename Sequence>
BrakeRelation explore_all_brakes() {
    const std::vector<std::pair<Duration, unsigned>> cases{
        {Duration{2}, 255U}, {Duration{5}, 0U}, {Duration{100}, 11U}, {Duration{200'000'000}, 128U}};
    std::optional<BrakeRelation> relation;
    std::uint64_t calls = 0U;
    for (const auto& [closes_within, invalid] : cases) {
        BrakeExplorer<Sequence> explorer{closes_within, static_cast<std::uint8_t>(invalid)};
        const BrakeRelation& found = explorer.explore();
        if (relation.has_value() && !(relation->situations == found.situations)) {
            throw std::runtime_error("the sequence behaves differently with other times or invalid numbers");
        }
        calls += found.calls;
        relation = found;
    }
    relation->calls = calls;
    return *relation;
}

}  // namespace mamori::verification

#endif  // MAMORI_VERIFICATION_SAFE_STATE_BRAKE_EXPLORER_HPP
