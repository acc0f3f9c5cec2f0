// SPDX-License-Identifier: Apache-2.0
#include "mamori/ports/conformance/rule_runner.hpp"

#include <algorithm>
#include <unordered_set>
#include <utility>

#include "mamori/kernel/base/assert.hpp"

namespace mamori::ports::conformance {
namespace {

/// Maximum steps in fixed order, per rule: sufficient to return to a state that another rule left.
constexpr std::size_t kRepetitionsMax = 8U;

/// Random numbers that depend on the seed only, not on the library. Source: Steele, Lea, Flood, "Fast
/// splittable pseudorandom number generators", OOPSLA 2014 (SplitMix64).
class Generator final {
  public:
    explicit Generator(std::uint64_t seed) noexcept : state_(seed) {}

    /// @return 0 .. count - 1; the small bias of the remainder is negligible.
    std::size_t draw(std::size_t count) noexcept {
        state_ += 0x9E3779B97F4A7C15U;
        std::uint64_t bits = state_;
        bits = (bits ^ (bits >> 30U)) * 0xBF58476D1CE4E5B9U;
        bits = (bits ^ (bits >> 27U)) * 0x94D049BB133111EBU;
        return static_cast<std::size_t>((bits ^ (bits >> 31U)) % count);
    }

  private:
    std::uint64_t state_;
};

/// Runs one or more trials and collects their results.
class Course final {
  public:
    Course(const TrialFactory& factory, std::string order) : factory_(factory), order_(std::move(order)) {
        begin_trial();
        for (std::size_t rule = 0U; rule < trial_->get_rule_count(); ++rule) {
            report_.rules.push_back({trial_->get_name(rule), trial_->get_requirement(rule), 0U});
        }
    }

    void begin_trial() {
        trial_.reset();  // first, since a port may own a resource that the next port needs
        trial_ = factory_();
        MAMORI_ENSURE(1, trial_ != nullptr);
        walk_.clear();
        ++report_.sequence_count;
        note_state();
    }

    /// Applies a rule whose precondition holds.
    void apply(std::size_t rule) {
        walk_.push_back(rule);
        ++report_.rules[rule].count;
        ++report_.step_count;
        Judge judge;
        trial_->apply(rule, judge);
        note_state();
        if (judge.has_finding()) {
            add_finding("rule '" + report_.rules[rule].name + "' (" + report_.rules[rule].requirement +
                        "): " + judge.get_finding());
        }
    }

    /// @return rules whose precondition holds. If there are none, adds a finding.
    Walk find_applicable() {
        Walk rules;
        for (std::size_t rule = 0U; rule < report_.rules.size(); ++rule) {
            if (trial_->may_apply(rule)) {
                rules.push_back(rule);
            }
        }
        if (rules.empty()) {
            add_finding("no rule is applicable in state " + trial_->describe_state());
        }
        return rules;
    }

    void add_finding(const std::string& finding) {
        std::string text =
            order_ + ", after " + std::to_string(walk_.size()) + " steps: " + finding + "; sequence:";
        for (const std::size_t rule : walk_) {
            text += " " + std::to_string(rule);
        }
        report_.findings.push_back(std::move(text));
    }

    bool may_go_on() const { return report_.findings.empty(); }
    bool may_apply(std::size_t rule) const { return rule < report_.rules.size() && trial_->may_apply(rule); }
    std::size_t get_count(std::size_t rule) const { return report_.rules[rule].count; }
    bool have_all_run() const {
        return std::all_of(report_.rules.begin(), report_.rules.end(),
                           [](const Report::RuleCount& rule) { return rule.count > 0U; });
    }
    std::size_t get_rule_count() const { return report_.rules.size(); }
    const Walk& get_walk() const { return walk_; }

    /// @return the report; rules that never ran are findings if there is no other finding.
    Report finish_all() {
        for (std::size_t rule = 0U; rule < get_rule_count() && may_go_on(); ++rule) {
            if (get_count(rule) == 0U) {
                add_finding("rule '" + report_.rules[rule].name + "' (" + report_.rules[rule].requirement +
                            ") never ran");
            }
        }
        return finish();
    }
    Report finish() {
        trial_.reset();
        report_.state_count = states_.size();
        return std::move(report_);
    }

  private:
    void note_state() { states_.insert(trial_->describe_state()); }

    const TrialFactory& factory_;
    std::string order_;
    std::unique_ptr<Trial> trial_;
    Walk walk_;
    std::unordered_set<std::string> states_;
    Report report_;
};

/// Beginnings of the sequences that are still to be applied.
using Pending = std::vector<Walk>;

/// Applies `beginning` to a new port and continues with the first applicable rule until the depth is reached.
/// The other applicable rules are added to `pending`.
void explore_from(Course& course, const Walk& beginning, std::size_t depth, Pending& pending) {
    for (std::size_t i = 0U; i < beginning.size() && course.may_go_on(); ++i) {
        if (!course.may_apply(beginning[i])) {
            course.add_finding("the same sequence led to a different state earlier");
            return;
        }
        course.apply(beginning[i]);
    }
    while (course.may_go_on() && course.get_walk().size() < depth) {
        const Walk applicable = course.find_applicable();
        for (std::size_t i = applicable.size(); i > 1U; --i) {
            Walk later = course.get_walk();
            later.push_back(applicable[i - 1U]);
            pending.push_back(std::move(later));
        }
        if (!applicable.empty()) {
            course.apply(applicable.front());
        }
    }
}

Course explore_depth(const TrialFactory& factory, std::size_t depth) {
    Course course{factory, "every order, depth " + std::to_string(depth)};
    Pending pending;
    explore_from(course, {}, depth, pending);
    while (!pending.empty() && course.may_go_on()) {
        const Walk beginning = std::move(pending.back());
        pending.pop_back();
        course.begin_trial();
        explore_from(course, beginning, depth, pending);
    }
    return course;
}

/// Continues in fixed order until each rule was applied: each step applies the first of the least applied
/// rules.
void apply_missing(Course& course) {
    const std::size_t step_count_max = kRepetitionsMax * course.get_rule_count();
    for (std::size_t step = 0U; step < step_count_max && course.may_go_on() && !course.have_all_run();
         ++step) {
        const Walk applicable = course.find_applicable();
        if (!applicable.empty()) {
            course.apply(*std::min_element(applicable.begin(), applicable.end(),
                                           [&course](std::size_t a, std::size_t b) {
                                               return course.get_count(a) < course.get_count(b);
                                           }));
        }
    }
}

}  // namespace

std::string Report::to_text() const {
    std::string text;
    for (const std::string& finding : findings) {
        text += finding + "\n";
    }
    if (is_kept()) {
        text = std::to_string(rules.size()) + " rules, " + std::to_string(sequence_count) + " sequences, " +
               std::to_string(step_count) + " steps, " + std::to_string(state_count) + " states\n";
        return text;
    }
    for (std::size_t rule = 0U; rule < rules.size(); ++rule) {
        text += "  " + std::to_string(rule) + " " + rules[rule].name + "\n";
    }
    return text;
}

Report run_in_order(const TrialFactory& factory) {
    Course course{factory, "fixed order"};
    apply_missing(course);
    return course.finish_all();
}

Report run_randomly(const TrialFactory& factory, std::uint64_t seed, std::size_t step_count) {
    Course course{factory, "random order, seed " + std::to_string(seed)};
    Generator generator{seed};
    for (std::size_t step = 0U; step < step_count && course.may_go_on(); ++step) {
        const Walk applicable = course.find_applicable();
        if (!applicable.empty()) {
            course.apply(applicable[generator.draw(applicable.size())]);
        }
    }
    apply_missing(course);
    return course.finish_all();
}

Report explore(const TrialFactory& factory, std::size_t depth) {
    MAMORI_REQUIRE(2, depth > 0U);
    for (std::size_t shorter = 1U; shorter < depth; ++shorter) {
        Report report = explore_depth(factory, shorter).finish();
        if (!report.is_kept()) {
            return report;
        }
    }
    return explore_depth(factory, depth).finish_all();
}

Report replay(const TrialFactory& factory, const Walk& walk) {
    Course course{factory, "replay"};
    for (std::size_t i = 0U; i < walk.size() && course.may_go_on(); ++i) {
        if (course.may_apply(walk[i])) {
            course.apply(walk[i]);
        } else {
            course.add_finding("rule " + std::to_string(walk[i]) + " is not applicable here");
        }
    }
    return course.finish();
}

}  // namespace mamori::ports::conformance
