// SPDX-License-Identifier: Apache-2.0
// Goal: the analysis of failure modes is that of the compiled reaction table and of the campaign.
// Method: the rows of the page are read and held against both, in both directions.
#include <fstream>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "arm_safety.hpp"
#include "mamori/trace/verifies.hpp"

namespace safe_arm {
namespace {

using namespace mamori::verification;

using Row = std::vector<std::string>;

enum Column : std::size_t { kItem, kMode, kEffect, kFault, kReaction, kWithin, kCases, kColumns };

std::string trim(const std::string& text) {
    const std::size_t first = text.find_first_not_of(' ');
    return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(' ') - first + 1U);
}

/// Rows of the tables with kColumns columns, without their heads.
std::vector<Row> read_rows() {
    std::ifstream file{SAFE_ARM_FMEA_PAGE};
    std::vector<Row> rows;
    std::string line;
    while (std::getline(file, line)) {
        std::istringstream cells{line};
        std::string cell;
        Row row;
        std::getline(cells, cell, '|');  // before the first bar
        while (std::getline(cells, cell, '|')) {
            row.push_back(trim(cell));
        }
        if (row.size() == kColumns && row[kFault] != "fault" && row[kFault] != "---") {
            rows.push_back(row);
        }
    }
    return rows;
}

std::set<std::string> read_campaign_cases() {
    std::ifstream file{SAFE_ARM_FAULTS_FILE};
    const std::string mark = "  - name: ";
    std::set<std::string> names;
    std::string line;
    while (std::getline(file, line)) {
        if (line.compare(0U, mark.size(), mark) == 0) {
            names.insert(trim(line.substr(mark.size())));
        }
    }
    return names;
}

constexpr auto kRows = mamori::system(mamori::frame(kFrame), kArmReactions).reactions;

TEST(FmeaTest, EachFaultOfTheCompiledTableHasARowWithItsReactionAndTime) {
    verifies("SWR-SAF-020", Technique::kBackToBack);
    std::set<std::string> told;
    for (const Row& row : read_rows()) {
        told.insert(row[kFault] + ": " + row[kReaction] + ", " + row[kWithin]);
    }

    std::set<std::string> compiled;
    for (const mamori::ReactionRow& row : kRows) {
        const std::string within = std::to_string(row.within.ns / 1000000) + " ms";
        compiled.insert(kArmFaultNames[row.fault] +
                        (": " + std::string{get_name(static_cast<Reaction>(row.reaction))}) + ", " + within);
    }
    EXPECT_EQ(told, compiled);
}

TEST(FmeaTest, EachCaseThatIsNamedIsOneOfTheCampaign) {
    verifies("SWR-SAF-020", Technique::kBackToBack, Polarity::kViolation);
    const std::set<std::string> known = read_campaign_cases();
    ASSERT_GT(known.size(), 10U);

    std::set<std::string> named;
    for (const Row& row : read_rows()) {
        std::istringstream cases{row[kCases]};
        std::string name;
        while (row[kCases] != "-" && std::getline(cases, name, ',')) {
            EXPECT_EQ(known.count(trim(name)), 1U) << name;
            named.insert(trim(name));
        }
    }
    EXPECT_GT(named.size(), 8U);
}

}  // namespace
}  // namespace safe_arm
