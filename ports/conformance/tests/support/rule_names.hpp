// SPDX-License-Identifier: Apache-2.0
// What a finding needs to be understood: the names and requirements of the rules of a contract.
#ifndef MAMORI_PORTS_CONFORMANCE_TESTS_RULE_NAMES_HPP
#define MAMORI_PORTS_CONFORMANCE_TESTS_RULE_NAMES_HPP

#include <gtest/gtest.h>

#include <set>
#include <string>

#include "mamori/ports/conformance/trial.hpp"

namespace mamori::ports::conformance {

/// Expects a name that no other rule has, and a requirement, of each rule of `factory`.
inline void expect_named_rules(const TrialFactory& factory) {
    const std::unique_ptr<Trial> trial = factory();
    std::set<std::string> names;
    for (std::size_t rule = 0U; rule < trial->get_rule_count(); ++rule) {
        EXPECT_NE(trial->get_name(rule), "") << rule;
        EXPECT_EQ(trial->get_requirement(rule).substr(0U, 4U), "SWR-") << trial->get_name(rule);
        names.insert(trial->get_name(rule));
    }
    EXPECT_EQ(names.size(), trial->get_rule_count());
}

}  // namespace mamori::ports::conformance

#endif  // MAMORI_PORTS_CONFORMANCE_TESTS_RULE_NAMES_HPP
