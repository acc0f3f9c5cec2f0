// SPDX-License-Identifier: Apache-2.0
/// @file
/// Calls the compiled step of a safe-state machine for every possible situation and every combination of its
/// inputs, and records the results: the complete step relation, from which models for provers are created.
///
/// @satisfies SWR-FSM-020, SWR-FSM-021      Design: docs/design/safe_state.md#step-relation
#ifndef MAMORI_VERIFICATION_SAFE_STATE_EXPLORER_HPP
#define MAMORI_VERIFICATION_SAFE_STATE_EXPLORER_HPP

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "mamori/safety/reaction/safe_state_machine.hpp"

namespace mamori::verification {

using safety::Reaction;
using safety::SafeState;
using safety::SafeStateInputs;
using safety::SelfTestStatus;
using safety::StopBounds;

/// Values of one input. A letter is one combination of all inputs: a number whose digits are the values; the
/// time is the last digit.
struct InputKind {
    const char* name;
    std::vector<const char*> values;
};

/// Classes of the time since the entry into the state.
enum class TimeClass : std::uint8_t { kBeforeEntry, kWithin, kAtBound, kBeyond };
inline constexpr std::size_t kTimeClassCount = 4U;

/// The time bound that affects the reaction of a situation.
enum class Limit : std::uint8_t { kNone, kSs2, kSs1 };

/// A situation of the machine: its complete memory, except the entry time of the state.
struct Situation {
    SafeState state{};
    bool is_consistent{true};
    Limit limit{Limit::kNone};
    std::vector<std::size_t> next;  ///< one situation for each letter
};

inline bool operator==(const Situation& a, const Situation& b) {
    return a.state == b.state && a.is_consistent == b.is_consistent && a.limit == b.limit && a.next == b.next;
}

/// The behaviour of the machine. Situation 0 is that after power-up.
struct Relation {
    std::vector<Situation> situations;
    std::uint64_t steps{0U};              ///< calls of the compiled step
    std::uint64_t corrupted_objects{0U};  ///< tried; their situations are last in `situations`
};

/// The inputs except time; `Invalid` represents each number that is not an enumerator.
inline std::vector<InputKind> make_input_kinds() {
    const std::vector<const char*> levels{"no", "yes"};
    return {{"demand", {"None", "Degrade", "Ss2", "Ss1", "Sto", "Invalid"}},
            {"self_test", {"Running", "Passed", "Failed", "Invalid"}},
            {"lock_out", levels},
            {"standstill", levels},
            {"faults_cleared", levels},
            {"start_permitted", levels},
            {"start_button", levels},
            {"reset_button", levels},
            {"brakes_failed", levels},
            {"time", {"BeforeEntry", "Within", "AtBound", "Beyond"}}};
}

/// One input row per letter without its time, in the order of make_input_kinds().
/// @param[in] invalid number that represents all values that are not enumerators, > Reaction::kSto.
inline std::vector<SafeStateInputs> make_all_inputs(std::uint8_t invalid) {
    std::vector<SafeStateInputs> all;
    for (unsigned demand = 0U; demand <= 5U; ++demand) {
        for (unsigned self_test = 0U; self_test <= 3U; ++self_test) {
            for (unsigned bits = 0U; bits < 128U; ++bits) {
                SafeStateInputs inputs;
                inputs.demand = static_cast<Reaction>(demand == 5U ? invalid : demand);
                inputs.self_test = static_cast<SelfTestStatus>(self_test == 3U ? invalid : self_test);
                inputs.lock_out = (bits & 64U) != 0U;
                inputs.standstill = (bits & 32U) != 0U;
                inputs.faults_cleared = (bits & 16U) != 0U;
                inputs.start_permitted = (bits & 8U) != 0U;
                inputs.start_button = (bits & 4U) != 0U;
                inputs.reset_button = (bits & 2U) != 0U;
                inputs.brakes_failed = (bits & 1U) != 0U;
                all.push_back(inputs);
            }
        }
    }
    return all;
}

/// Explores one machine with one pair of bounds. Situations are distinguished by the bytes of the object, so
/// that no part of the memory of the machine is overlooked.
/// @tparam Machine SafeStateMachine, or a machine with its interface.
template <typename Machine>
class Explorer final {
    static_assert(std::is_trivially_copyable_v<Machine>, "situations are compared by their bytes");

  public:
    /// @param[in] bounds both > 0; their difference exceeds 1, to distinguish which of them a situation uses.
    explicit Explorer(StopBounds bounds, std::uint8_t invalid = 0xFFU)
        : bounds_(bounds), inputs_(make_all_inputs(invalid)), machine_(bounds) {
        find_entry_time();
        const std::int64_t ss2 = bounds.ss2_within.ns;
        const std::int64_t ss1 = bounds.ss1_within.ns;
        elapsed_ = {-kFar, -1, 0, 1, ss2 - 1, ss2, ss2 + 1, ss1 - 1, ss1, ss1 + 1, kFar};
    }

    /// @return all situations that are reachable from power-up by inputs.
    /// @throw std::runtime_error if the machine depends on time in another way than by one bound per
    /// situation, or has more than kSituationsMax situations.
    const Relation& explore() {
        static_cast<void>(find_or_add(store()));
        for (std::size_t i = 0U; i < images_.size(); ++i) {
            explore_situation(i);
        }
        renumber();
        return relation_;
    }

    /// Adds the behaviour of the object after a detected flip of one of its bits: one situation for all
    /// objects with equal behaviour. Call after explore().
    const Relation& explore_corrupted() {
        std::vector<Situation> found;
        const std::size_t count = images_.size();
        for (std::size_t i = 0U; i < count; ++i) {
            for (std::size_t bit = 0U; bit < sizeof(Machine) * 8U; ++bit) {
                Image image = images_[i];
                image[bit / 8U] = static_cast<unsigned char>(image[bit / 8U] ^ (1U << (bit % 8U)));
                if (load(image).is_consistent()) {
                    continue;  // a flip that the machine cannot detect; listed in safe_state.md#corruption
                }
                ++relation_.corrupted_objects;
                const Situation situation = answer_corrupted(image);
                if (std::find(found.begin(), found.end(), situation) == found.end()) {
                    found.push_back(situation);
                }
            }
        }
        if (images_.size() != count) {
            throw std::runtime_error("a corrupted object leads to a situation that no inputs lead to");
        }
        relation_.situations.insert(relation_.situations.end(), found.begin(), found.end());
        return relation_;
    }

    static constexpr std::size_t kSituationsMax = 200U;

  private:
    using Image = std::array<unsigned char, sizeof(Machine)>;

    static constexpr std::int64_t kFar = 1'000'000'000'000'000;           // eleven days
    static constexpr std::int64_t kLateBase = 4'000'000'000'000'000'000;  // the year 2096
    static constexpr std::array<std::int64_t, 2U> kBases{0, kLateBase};   // entries into the state

    /// The only working object: bytes between its members keep their values, unlike those of a local copy.
    Machine& load(const Image& image) {
        std::memcpy(static_cast<void*>(&machine_), image.data(), image.size());
        return machine_;
    }

    Image store() const {
        Image image{};
        std::memcpy(image.data(), &machine_, image.size());
        return image;
    }

    /// Finds the bytes that hold the entry time: those that differ between first steps at 0 and at -1.
    void find_entry_time() {
        const Image fresh = store();
        std::array<Image, 2U> images{};
        for (std::size_t i = 0U; i < images.size(); ++i) {
            SafeStateInputs inputs = inputs_.front();
            inputs.now = Instant{i == 0U ? 0 : -1};
            static_cast<void>(load(fresh).step(inputs));
            images[i] = store();
        }
        static_cast<void>(load(fresh));
        std::size_t count = 0U;
        for (std::size_t i = 0U; i < sizeof(Machine); ++i) {
            if (images[0][i] != images[1][i]) {
                entry_time_at_ = count == 0U ? i : entry_time_at_;
                ++count;
            }
        }
        if (count != sizeof(Instant)) {
            throw std::runtime_error("the machine keeps its entry time in another way than as one instant");
        }
    }

    Image with_entry(const Image& image, std::int64_t at) const {
        Image moved = image;
        std::memcpy(moved.data() + entry_time_at_, &at, sizeof(at));
        return moved;
    }

    std::size_t find_or_add(const Image& image) {
        if (last_ < images_.size() && images_[last_] == image) {
            return last_;  // most often: times of one class follow each other
        }
        const auto [place, is_new] = numbers_.insert({image, images_.size()});
        last_ = place->second;
        if (is_new) {
            if (images_.size() == kSituationsMax) {
                throw std::runtime_error("the machine has no end of situations");
            }
            images_.push_back(image);
            const Machine& machine = load(image);
            relation_.situations.push_back({machine.get_state(), machine.is_consistent(), Limit::kNone, {}});
        }
        return place->second;
    }

    /// @return the situation after the step.
    std::size_t take_step(const Image& image, SafeStateInputs inputs, std::int64_t base,
                          std::int64_t elapsed) {
        Machine& machine = load(with_entry(image, base));
        const SafeState before = machine.get_state();
        const bool is_first = image == images_.front();
        const bool was_consistent = machine.is_consistent();
        inputs.now = Instant{base + elapsed};
        const SafeState after = machine.step(inputs);
        ++relation_.steps;
        const Instant expected = before != after || is_first ? inputs.now : Instant{base};
        if (after != machine.get_state() || (was_consistent && !(machine.get_entered_at() == expected))) {
            throw std::runtime_error("a step answers one state and keeps another, or another time of entry");
        }
        return find_or_add(with_entry(store(), 0));
    }

    /// Tries the bounds one after the other until the results agree within each class of times.
    void explore_situation(std::size_t number) {
        for (const Limit limit : {Limit::kNone, Limit::kSs2, Limit::kSs1}) {
            const Image image = images_[number];  // a copy: the list grows meanwhile
            if (const auto next = try_limit(image, limit)) {
                relation_.situations[number].limit = limit;
                relation_.situations[number].next = *next;
                return;
            }
        }
        throw std::runtime_error("situation " + std::to_string(number) +
                                 ": the step depends on time in another way than by one bound");
    }

    /// Numbers the situations in the order of a traversal of the letters, because the order of their
    /// discovery depends on the bounds.
    void renumber() {
        std::vector<std::size_t> order{0U};
        std::vector<std::size_t> place(images_.size(), 0U);
        std::vector<bool> is_met(images_.size(), false);
        is_met[0] = true;
        for (std::size_t i = 0U; i < order.size(); ++i) {
            for (const std::size_t next : relation_.situations[order[i]].next) {
                if (!is_met[next]) {
                    is_met[next] = true;
                    place[next] = order.size();
                    order.push_back(next);
                }
            }
        }
        const std::vector<Image> images = images_;
        const std::vector<Situation> situations = relation_.situations;
        for (std::size_t i = 0U; i < order.size(); ++i) {
            images_[i] = images[order[i]];
            numbers_[images_[i]] = i;
            relation_.situations[i] = situations[order[i]];
            for (std::size_t& next : relation_.situations[i].next) {
                next = place[next];
            }
        }
    }

    TimeClass classify(Limit limit, std::int64_t elapsed) const {
        const std::int64_t bound = limit == Limit::kSs2 ? bounds_.ss2_within.ns : bounds_.ss1_within.ns;
        if (elapsed < 0) {
            return TimeClass::kBeforeEntry;
        }
        return elapsed < bound    ? TimeClass::kWithin
               : elapsed == bound ? TimeClass::kAtBound
                                  : TimeClass::kBeyond;
    }

    /// @return the next situation for each letter; nothing if two times of one class give two results.
    std::optional<std::vector<std::size_t>> try_limit(const Image& image, Limit limit) {
        std::vector<std::size_t> next;
        for (const SafeStateInputs& inputs : inputs_) {
            std::array<std::optional<std::size_t>, kTimeClassCount> answers;
            for (const std::int64_t elapsed : elapsed_) {
                for (const std::int64_t base : kBases) {
                    const std::size_t answer = take_step(image, inputs, base, elapsed);
                    if (!note(limit, classify(limit, elapsed), answer, answers)) {
                        return std::nullopt;
                    }
                }
            }
            for (const auto& answer : answers) {
                next.push_back(answer.value());
            }
        }
        return next;
    }

    /// @return false if a different result was recorded before.
    static bool note(Limit limit, TimeClass time, std::size_t answer,
                     std::array<std::optional<std::size_t>, kTimeClassCount>& answers) {
        for (std::size_t i = 0U; i < kTimeClassCount; ++i) {
            if (limit == Limit::kNone || i == static_cast<std::size_t>(time)) {
                if (answers[i].value_or(answer) != answer) {
                    return false;
                }
                answers[i] = answer;
            }
        }
        return true;
    }

    Situation answer_corrupted(const Image& image) {
        const Machine& machine = load(image);
        Situation situation{machine.get_state(), machine.is_consistent(), Limit::kNone, {}};
        for (const SafeStateInputs& inputs : inputs_) {
            const std::size_t answer = take_step(image, inputs, 0, 0);
            for (const std::int64_t elapsed : {-kFar, kFar}) {
                if (take_step(image, inputs, 0, elapsed) != answer) {
                    throw std::runtime_error("what a corrupted object does depends on time");
                }
            }
            situation.next.insert(situation.next.end(), kTimeClassCount, answer);
        }
        return situation;
    }

    StopBounds bounds_;
    std::vector<SafeStateInputs> inputs_;
    Machine machine_;
    std::vector<std::int64_t> elapsed_;
    std::size_t entry_time_at_{0U};
    std::map<Image, std::size_t> numbers_;
    std::size_t last_{0U};  ///< found
    std::vector<Image> images_;
    Relation relation_;
};

/// Explores with several bounds and several invalid numbers.
/// @return the relation, which is equal for all of them.
/// @throw std::runtime_error if the relations differ, and the errors of Explorer.
template <typename Machine>
Relation explore_all() {
    const std::vector<std::pair<StopBounds, unsigned>> cases{
        {{Duration{2}, Duration{5}}, 255U},
        {{Duration{5}, Duration{2}}, 5U},
        {{Duration{1}, Duration{100}}, 127U},
        {{Duration{500'000'000}, Duration{1'000'000'000}}, 128U}};
    Explorer<Machine> explorer{cases.front().first, static_cast<std::uint8_t>(cases.front().second)};
    Relation relation = explorer.explore();
    std::uint64_t steps = 0U;
    for (std::size_t i = 1U; i < cases.size(); ++i) {
        Explorer<Machine> other{cases[i].first, static_cast<std::uint8_t>(cases[i].second)};
        const Relation& again = other.explore();
        if (!(again.situations == relation.situations)) {
            throw std::runtime_error("the machine behaves differently with other bounds or invalid numbers");
        }
        steps += again.steps;
    }
    relation = explorer.explore_corrupted();
    relation.steps += steps;
    return relation;
}

}  // namespace mamori::verification

#endif  // MAMORI_VERIFICATION_SAFE_STATE_EXPLORER_HPP
