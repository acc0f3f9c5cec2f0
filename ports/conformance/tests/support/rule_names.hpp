// SPDX-License-Identifier: Apache-2.0
// What a finding needs to be understood: the names and requirements of the rules of a contract, and the
// states of its model.
#ifndef MAMORI_PORTS_CONFORMANCE_TESTS_RULE_NAMES_HPP
#define MAMORI_PORTS_CONFORMANCE_TESTS_RULE_NAMES_HPP

#include <gtest/gtest.h>

#include <cctype>
#include <set>
#include <string>
#include <vector>

#include "mamori/ports/conformance/rule_runner.hpp"
#include "mamori/ports/conformance/trial.hpp"

namespace mamori::ports::conformance {

/// Expects a name that no other rule has, and a requirement, of each rule of `factory`.
inline void expect_named_rules(const TrialFactory& factory) {
    const std::unique_ptr<Trial> trial = factory();
    std::set<std::string> names;
    for (std::size_t rule = 0U; rule < trial->get_rule_count(); ++rule) {
        EXPECT_TRUE(std::isalpha(static_cast<unsigned char>(trial->get_name(rule)[0]))) << rule;
        EXPECT_EQ(trial->get_requirement(rule).substr(0U, 4U), "SWR-") << trial->get_name(rule);
        names.insert(trial->get_name(rule));
    }
    EXPECT_EQ(names.size(), trial->get_rule_count());
}

/// Applies `walk` to a new port that complies with the contract. @return the states of the model from the
/// initial one on.
inline std::vector<std::string> list_states(const TrialFactory& factory, const Walk& walk) {
    const std::unique_ptr<Trial> trial = factory();
    std::vector<std::string> states{trial->describe_state()};
    for (const std::size_t rule : walk) {
        Judge judge;
        EXPECT_TRUE(trial->may_apply(rule)) << rule;
        trial->apply(rule, judge);
        EXPECT_EQ(judge.get_finding(), "") << rule;
        states.push_back(trial->describe_state());
    }
    return states;
}

}  // namespace mamori::ports::conformance

#endif  // MAMORI_PORTS_CONFORMANCE_TESTS_RULE_NAMES_HPP
