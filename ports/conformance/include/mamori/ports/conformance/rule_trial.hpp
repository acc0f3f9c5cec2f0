// SPDX-License-Identifier: Apache-2.0
/// @file
/// A contract as a list of rules for one type, the subject, which contains the test adapter of a port and the
/// model.
///
/// @satisfies SWR-CNF-008      Design: docs/design/conformance.md#rules
#ifndef MAMORI_PORTS_CONFORMANCE_RULE_TRIAL_HPP
#define MAMORI_PORTS_CONFORMANCE_RULE_TRIAL_HPP

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "mamori/ports/conformance/trial.hpp"

namespace mamori::ports::conformance {

/// A rule: an action, its precondition, and the expected state afterwards.
template <typename Subject>
struct Rule {
    std::string name;
    std::string requirement;
    std::function<bool(const Subject&)> precondition;  ///< evaluates the model only, not the port
    std::function<void(Subject&, Judge&)> action;
};

template <typename Subject>
using Rules = std::vector<Rule<Subject>>;

/// Trial of a subject that has `std::string describe_state() const`.
template <typename Subject>
class RuleTrial final : public Trial {
  public:
    /// @param[in] rules   at least one; shared by all trials of the contract.
    /// @param[in] subject not nullptr.
    RuleTrial(std::shared_ptr<const Rules<Subject>> rules, std::unique_ptr<Subject> subject)
        : rules_(std::move(rules)), subject_(std::move(subject)) {}

    std::size_t get_rule_count() const noexcept override { return rules_->size(); }
    const std::string& get_name(std::size_t rule) const override { return rules_->at(rule).name; }
    const std::string& get_requirement(std::size_t rule) const override {
        return rules_->at(rule).requirement;
    }
    bool may_apply(std::size_t rule) const override { return rules_->at(rule).precondition(*subject_); }
    void apply(std::size_t rule, Judge& judge) override { rules_->at(rule).action(*subject_, judge); }
    std::string describe_state() const override { return subject_->describe_state(); }

  private:
    std::shared_ptr<const Rules<Subject>> rules_;
    std::unique_ptr<Subject> subject_;
};

/// Trials of one list of rules. @param[in] make_subject returns a new port with its model on each call.
template <typename Subject>
TrialFactory make_trials(Rules<Subject> rules, std::function<std::unique_ptr<Subject>()> make_subject) {
    const auto shared = std::make_shared<const Rules<Subject>>(std::move(rules));
    return [shared, make_subject = std::move(make_subject)]() -> std::unique_ptr<Trial> {
        return std::make_unique<RuleTrial<Subject>>(shared, make_subject());
    };
}

}  // namespace mamori::ports::conformance

#endif  // MAMORI_PORTS_CONFORMANCE_RULE_TRIAL_HPP
