// SPDX-License-Identifier: Apache-2.0
/// @file
/// Interface between runners, rules and one port under test. A rule reports differences between the port and
/// the model of the contract.
///
/// @satisfies SWR-CNF-008      Design: docs/design/conformance.md#rules
#ifndef MAMORI_PORTS_CONFORMANCE_TRIAL_HPP
#define MAMORI_PORTS_CONFORMANCE_TRIAL_HPP

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "mamori/kernel/base/time.hpp"

namespace mamori::ports::conformance {

/// Records the first failed expectation of a rule.
///
/// Thread safety: none. Time: creates text only for a failed expectation.
class Judge final {
  public:
    /// @param[in] sentence text of the finding if the expectation fails.
    void expect(bool holds, const char* sentence);
    void expect_equal(std::int64_t actual, std::int64_t expected, const char* sentence);
    void expect_equal(Instant actual, Instant expected, const char* sentence);

    bool has_finding() const noexcept { return !finding_.empty(); }
    /// The first failed expectation; empty if there is none.
    const std::string& get_finding() const noexcept { return finding_; }

  private:
    std::string finding_;
};

/// A new port, its model, and the rules, which compare both after each action.
///
/// Thread safety: none. Time: as the test adapter of the port.
class Trial {
  public:
    Trial() = default;
    virtual ~Trial() = default;
    Trial(const Trial&) = delete;
    Trial& operator=(const Trial&) = delete;

    /// Number of rules, > 0; equal for all trials of a contract.
    virtual std::size_t get_rule_count() const noexcept = 0;
    /// @param[in] rule 0 .. get_rule_count() - 1, here and below. @return unique name of the rule.
    virtual const std::string& get_name(std::size_t rule) const = 0;
    /// Id of the requirement that the rule checks.
    virtual const std::string& get_requirement(std::size_t rule) const = 0;
    /// Evaluates the precondition of the rule on the model.
    virtual bool may_apply(std::size_t rule) const = 0;
    /// Applies the rule to port and model and compares them. The precondition must hold.
    virtual void apply(std::size_t rule, Judge& judge) = 0;
    /// State of the model as text; equal texts are equal states.
    virtual std::string describe_state() const = 0;
};

/// Makes a new trial with a new port.
using TrialFactory = std::function<std::unique_ptr<Trial>()>;

/// Selects some of the rules, so that explore() can use a greater depth.
/// @param[in] names names of rules, at least one; an unknown name is a contract violation.
TrialFactory select_rules(TrialFactory factory, std::vector<std::string> names);

/// Makes a new port with its test adapter.
template <typename Rig>
using RigFactory = std::function<std::unique_ptr<Rig>()>;

}  // namespace mamori::ports::conformance

#endif  // MAMORI_PORTS_CONFORMANCE_TRIAL_HPP
