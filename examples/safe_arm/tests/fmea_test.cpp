// SPDX-License-Identifier: Apache-2.0
// Goal: the analysis of failure modes is that of the compiled reaction table and of the campaign.
// Method: the rows of the page are read and compared with both, in both directions.
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "arm_safety.hpp"
#include "mamori/trace/verifies.hpp"
#include "table_output.hpp"

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

/// One case of the campaign, as its plan states it.
struct Case {
    std::string kind;    ///< of the injected fault
    std::string latent;  ///< empty: none
    std::string detected_faults;
};

/// From `mark` to the next of `ends`; empty if there is no `mark`.
std::string find_value(const std::string& text, const std::string& mark, const std::string& ends) {
    const std::size_t begin = text.find(mark);
    if (begin == std::string::npos) {
        return "";
    }
    const std::size_t first = begin + mark.size();
    return text.substr(first, text.find_first_of(ends, first) - first);
}

std::map<std::string, Case> read_campaign_cases() {
    std::ostringstream text;
    text << std::ifstream{SAFE_ARM_FAULTS_FILE}.rdbuf();
    const std::string plan = text.str();
    const std::string mark = "  - name: ";
    std::map<std::string, Case> cases;
    for (std::size_t at = plan.find(mark); at != std::string::npos;) {
        const std::size_t next = plan.find(mark, at + 1U);
        const std::string part = plan.substr(at, next - at);
        cases[find_value(part, mark, "\n")] = {find_value(part, "kind: ", ",}"),
                                               find_value(part, "latent: ", ",}"),
                                               ", " + find_value(part, "detected_fault: [", "]") + ","};
        at = next;
    }
    return cases;
}

/// Names in the column of cases, without what stands in brackets behind them.
std::vector<std::string> list_cases(const Row& row) {
    std::istringstream cells{row[kCases]};
    std::vector<std::string> names;
    std::string name;
    while (row[kCases] != "-" && std::getline(cells, name, ',')) {
        name = trim(name);
        names.push_back(name.substr(0U, name.find(' ')));
    }
    return names;
}

std::string to_text(mamori::Duration time) {
    return std::to_string(time.ns / 1000000) + " ms";
}

constexpr auto kRows = mamori::system(mamori::frame(kFrame), kArmReactions).reactions;

TEST(FmeaTest, EachFaultOfTheCompiledTableHasARowWithItsReactionAndTime) {
    verifies("SWR-SAF-020", Technique::kBackToBack);
    std::set<std::string> told;
    for (const Row& row : read_rows()) {
        told.insert(row[kFault] + ": " + row[kReaction] + ", " + row[kWithin]);
    }

    // Without the software, the watchdog acts; drives that ignore it are locked out. A stuck button does
    // nothing.
    std::set<std::string> compiled{"-: -, -", "-: Sto, " + to_text(kWatchdogTimeout),
                                   "-: LockedOut, " + to_text(kTorqueFeedbackTime)};
    for (const mamori::ReactionRow& row : kRows) {
        if (row.reaction == static_cast<std::uint32_t>(Reaction::kNone)) {
            continue;  // a control that a mode does not need
        }
        compiled.insert(get_fault_names()[row.fault] +
                        (": " + std::string{get_name(static_cast<Reaction>(row.reaction))}) + ", " +
                        to_text(row.within));
    }
    EXPECT_EQ(told, compiled);
}

TEST(FmeaTest, EachFaultOfEachCaseOfTheCampaignHasARow) {
    verifies("SWR-SAF-020", Technique::kBackToBack, Polarity::kViolation);
    const std::map<std::string, Case> known = read_campaign_cases();
    ASSERT_GT(known.size(), 20U);

    std::map<std::string, std::size_t> rows_of;
    std::set<std::string> detected;
    for (const Row& row : read_rows()) {
        for (const std::string& name : list_cases(row)) {
            ASSERT_EQ(known.count(name), 1U) << name << " is no case of the campaign";
            ++rows_of[name];
            if (row[kFault] == "-" ||
                known.at(name).detected_faults.find(" " + row[kFault] + ",") != std::string::npos) {
                detected.insert(name);
            }
        }
    }
    for (const auto& [name, one] : known) {
        const bool is_mode = one.latent == "reduced_speed" || one.latent == "hold_to_run";
        const std::size_t faults = (one.kind == "none" ? 0U : 1U) + (one.latent.empty() || is_mode ? 0U : 1U);
        EXPECT_GE(rows_of[name], faults) << name << " needs a row for each of its faults";
        EXPECT_TRUE(faults == 0U || one.detected_faults == ", None," || detected.count(name) == 1U)
            << name << " is in no row of the fault that it leads to";
    }
}

}  // namespace
}  // namespace safe_arm
