// SPDX-License-Identifier: Apache-2.0
/// @file
/// One port under the rules of one contract: what a runner needs to know of it, and how a rule says that the
/// port and the model of the contract differ.
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

/// Hears what the rules expect and keeps the first thing that was not so.
///
/// Thread safety: none. Time: a text is made only where an expectation fails.
class Judge final {
  public:
    /// @param[in] sentence what the contract says; ends up in the finding when it does not hold.
    void expect(bool holds, const char* sentence);
    void expect_equal(std::int64_t actual, std::int64_t expected, const char* sentence);
    void expect_equal(Instant actual, Instant expected, const char* sentence);

    bool has_finding() const noexcept { return !finding_.empty(); }
    /// The first expectation that failed; empty while there is none.
    const std::string& get_finding() const noexcept { return finding_; }

  private:
    std::string finding_;
};

/// A port in the state in which it begins, its model, and the rules that compare the two after each action.
///
/// Thread safety: none. Time: as the port's rig.
class Trial {
  public:
    Trial() = default;
    virtual ~Trial() = default;
    Trial(const Trial&) = delete;
    Trial& operator=(const Trial&) = delete;

    /// The same for each trial of a contract, > 0.
    virtual std::size_t get_rule_count() const noexcept = 0;
    /// @param[in] rule 0 .. get_rule_count() - 1, here and below. @return a name that no other rule has.
    virtual const std::string& get_name(std::size_t rule) const = 0;
    /// Id of the requirement that the rule checks.
    virtual const std::string& get_requirement(std::size_t rule) const = 0;
    /// Precondition of the rule, asked of the model.
    virtual bool may_apply(std::size_t rule) const = 0;
    /// Acts on port and model and compares them. The precondition must hold.
    virtual void apply(std::size_t rule, Judge& judge) = 0;
    /// State of the model in words: two states with the same words are the same.
    virtual std::string describe_state() const = 0;
};

/// Makes a new trial with a new port.
using TrialFactory = std::function<std::unique_ptr<Trial>()>;

/// The same trials with some of their rules: a smaller choice lets explore() go deeper.
/// @param[in] names of rules, at least one; one that no rule has is an own bug.
TrialFactory select_rules(TrialFactory factory, std::vector<std::string> names);

/// Makes a new port with what the rules of a contract need around it.
template <typename Rig>
using RigFactory = std::function<std::unique_ptr<Rig>()>;

}  // namespace mamori::ports::conformance

#endif  // MAMORI_PORTS_CONFORMANCE_TRIAL_HPP
