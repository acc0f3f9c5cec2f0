// SPDX-License-Identifier: Apache-2.0
#include "mamori/ports/conformance/trial.hpp"

#include <algorithm>
#include <utility>

#include "mamori/kernel/base/assert.hpp"

namespace mamori::ports::conformance {
namespace {

class SelectedTrial final : public Trial {
  public:
    SelectedTrial(std::unique_ptr<Trial> whole, const std::vector<std::string>& names)
        : whole_(std::move(whole)) {
        for (std::size_t rule = 0U; rule < whole_->get_rule_count(); ++rule) {
            if (std::find(names.begin(), names.end(), whole_->get_name(rule)) != names.end()) {
                rules_.push_back(rule);
            }
        }
        MAMORI_REQUIRE(1, !names.empty() && rules_.size() == names.size());
    }

    std::size_t get_rule_count() const noexcept override { return rules_.size(); }
    const std::string& get_name(std::size_t rule) const override { return whole_->get_name(rules_.at(rule)); }
    const std::string& get_requirement(std::size_t rule) const override {
        return whole_->get_requirement(rules_.at(rule));
    }
    bool may_apply(std::size_t rule) const override { return whole_->may_apply(rules_.at(rule)); }
    void apply(std::size_t rule, Judge& judge) override { whole_->apply(rules_.at(rule), judge); }
    std::string describe_state() const override { return whole_->describe_state(); }

  private:
    std::unique_ptr<Trial> whole_;
    std::vector<std::size_t> rules_;
};

}  // namespace

TrialFactory select_rules(TrialFactory factory, std::vector<std::string> names) {
    return [factory = std::move(factory), names = std::move(names)]() -> std::unique_ptr<Trial> {
        return std::make_unique<SelectedTrial>(factory(), names);
    };
}

void Judge::expect(bool holds, const char* sentence) {
    if (!holds && finding_.empty()) {
        finding_ = sentence;
    }
}

void Judge::expect_equal(std::int64_t actual, std::int64_t expected, const char* sentence) {
    if (actual != expected && finding_.empty()) {
        finding_ =
            std::string{sentence} + ": " + std::to_string(actual) + ", expected " + std::to_string(expected);
    }
}

void Judge::expect_equal(Instant actual, Instant expected, const char* sentence) {
    expect_equal(actual.ns, expected.ns, sentence);
}

}  // namespace mamori::ports::conformance
