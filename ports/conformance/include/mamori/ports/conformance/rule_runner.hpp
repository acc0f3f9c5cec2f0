// SPDX-License-Identifier: Apache-2.0
/// @file
/// Applies the rules of a contract to a port: once in their order, in a seeded random order, or in every
/// order there is up to a depth. A rule that never ran is a finding like one that failed.
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

/// Rules by their numbers, in the order in which they are applied.
using Walk = std::vector<std::size_t>;

/// What came of a run.
struct Report {
    /// How often a rule was applied.
    struct RuleCount {
        std::string name;
        std::string requirement;
        std::size_t count{0U};
    };

    /// Sentences with everything that is needed to see it again: order, seed, the walk until then, the rule,
    /// its requirement, and what was not so. Empty: the port keeps the contract.
    std::vector<std::string> findings;
    std::vector<RuleCount> rules;
    std::size_t sequence_count{0U};  ///< walks from a new port on
    std::size_t step_count{0U};      ///< rules applied, all walks together
    std::size_t state_count{0U};     ///< different states of the model, the first one included

    bool is_kept() const noexcept { return findings.empty(); }
    /// The findings, or one line with the counts; never empty.
    std::string to_text() const;
};

/// Applies each rule, in the order of the contract as far as their preconditions hold: at each step the first
/// of those that were applied least often, until every rule was applied.
Report run_in_order(const TrialFactory& factory);

/// Applies `step_count` rules, each chosen at random from those whose precondition holds; then, in the fixed
/// order, until each was applied, so that no rule is left out by chance.
/// @param[in] seed the same seed gives the same walk with each compiler and library, as long as the port
///            answers the same.
Report run_randomly(const TrialFactory& factory, std::uint64_t seed, std::size_t step_count);

/// Applies every sequence of `depth` rules whose preconditions hold one after the other, each to a new port;
/// the short ones first, so that a finding shows one of the shortest. Time: exponential in the depth.
/// @param[in] depth > 0.
Report explore(const TrialFactory& factory, std::size_t depth);

/// Applies one walk again, for instance that of a finding. A rule whose precondition does not hold, or that
/// does not exist, is a finding; rules that the walk leaves out are none.
Report replay(const TrialFactory& factory, const Walk& walk);

}  // namespace mamori::ports::conformance

#endif  // MAMORI_PORTS_CONFORMANCE_RULE_RUNNER_HPP
