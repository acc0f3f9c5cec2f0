// SPDX-License-Identifier: Apache-2.0
/// @file
/// Applies the rules of a contract to a port: once in fixed order, in a seeded random order, or in every
/// order up to a depth. A rule that never ran is a finding, like a failed rule.
///
/// @satisfies SWR-CNF-008, SWR-CNF-009, SWR-CNF-010      Design: docs/design/conformance.md#orders
#ifndef MAMORI_PORTS_CONFORMANCE_RULE_RUNNER_HPP
#define MAMORI_PORTS_CONFORMANCE_RULE_RUNNER_HPP

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "mamori/ports/conformance/trial.hpp"

namespace mamori::ports::conformance {

/// Action sequence: numbers of rules in the order of their application.
using Walk = std::vector<std::size_t>;

/// Result of a run.
struct Report {
    /// How often a rule was applied.
    struct RuleCount {
        std::string name;
        std::string requirement;
        std::size_t count{0U};
    };

    /// Findings with all data to reproduce them: order, seed, action sequence, rule, requirement and failed
    /// expectation. Empty: the port complies with the contract.
    std::vector<std::string> findings;
    std::vector<RuleCount> rules;
    std::size_t sequence_count{0U};  ///< action sequences, each on a new port
    std::size_t step_count{0U};      ///< applied rules of all sequences
    std::size_t state_count{0U};     ///< different states of the model, including the initial state

    bool is_kept() const noexcept { return findings.empty(); }
    /// Text of the findings, or one line with the counts; never empty.
    std::string to_text() const;
};

/// Applies all rules. Each step applies the rule with the fewest applications among those whose precondition
/// holds; the order of the contract decides between equal counts. Ends when each rule was applied.
Report run_in_order(const TrialFactory& factory);

/// Applies `step_count` rules, each selected at random from those whose precondition holds. Then continues in
/// fixed order until each rule was applied, so that no rule is omitted by chance.
/// @param[in] seed a seed gives the same sequence with each compiler and library if the port behaves the
///            same.
Report run_randomly(const TrialFactory& factory, std::uint64_t seed, std::size_t step_count);

/// Applies every sequence of `depth` rules that the preconditions permit, each to a new port. Shorter
/// sequences are applied first, so that a finding shows a shortest sequence. Time: exponential in the depth.
/// @param[in] depth > 0.
Report explore(const TrialFactory& factory, std::size_t depth);

/// Applies one sequence again, for example that of a finding. A rule that does not exist, or whose
/// precondition does not hold, is a finding. Rules that are not in the sequence are not findings.
Report replay(const TrialFactory& factory, const Walk& walk);

}  // namespace mamori::ports::conformance

#endif  // MAMORI_PORTS_CONFORMANCE_RULE_RUNNER_HPP
