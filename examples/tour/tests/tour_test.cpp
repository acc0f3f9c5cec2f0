// SPDX-License-Identifier: Apache-2.0
// Goal: each program of the tour shows what its page of the manual states. Method: run it and compare its
// output with the first text block of the page.
#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <fstream>
#include <sstream>
#include <string>

#include <sys/wait.h>
#include <unistd.h>

#include "mamori/trace/verifies.hpp"

namespace {

using namespace mamori::verification;

/// Output of the program; ends with a line that names the exit status if it is not 0.
std::string run(const std::string& name, const std::string& argument = {}) {
    const std::string command = "'" TOUR_PROGRAMS + name + "' " + argument;
    FILE* pipe = popen(command.c_str(), "r");
    if (pipe == nullptr) {
        return "cannot run " + command;
    }
    std::string text;
    std::array<char, 256U> part{};
    while (fgets(part.data(), static_cast<int>(part.size()), pipe) != nullptr) {
        text += part.data();
    }
    const int status = pclose(pipe);
    return status == 0 ? text : text + "exit status " + std::to_string(WEXITSTATUS(status)) + "\n";
}

/// First text block of a page of the manual; empty if there is none.
std::string read_shown_output(const std::string& name) {
    const std::string begin = "\n```text\n";
    std::ifstream file{TOUR_MANUAL + name + ".md"};
    std::stringstream page;
    page << file.rdbuf();
    const std::string text = page.str();
    const std::size_t first = text.find(begin);
    const std::size_t last = text.find("```", first + begin.size());
    return first == std::string::npos ? std::string{}
                                      : text.substr(first + begin.size(), last - first - begin.size());
}

void expect_output_of_page(const std::string& name) {
    const std::string shown = read_shown_output(name);

    ASSERT_FALSE(shown.empty());
    EXPECT_EQ(run(name), shown);
}

TEST(TourTest, FifoPortsKeepTheNewestOrTheOldestValuesAsThePageShows) {
    verifies("SWR-KRN-029", Technique::kBackToBack);
    expect_output_of_page("fifo_ports");
}

TEST(TourTest, TwoCoresExchangeValuesAtWindowStartsAsThePageShows) {
    verifies("SWR-KRN-026", Technique::kBackToBack);
    expect_output_of_page("two_cores");
}

TEST(TourTest, FsmComponentFollowsItsTableAsThePageShows) {
    verifies("SWR-RTC-006", Technique::kBackToBack);
    expect_output_of_page("fsm_component");
}

TEST(TourTest, SystemModesAreSwitchedAsThePageShows) {
    verifies("SWR-MOD-004", Technique::kBackToBack);
    expect_output_of_page("system_modes");
}

TEST(TourTest, SafetyModuleStopsTheRobotAsThePageShows) {
    verifies("SWR-CYC-003", Technique::kBackToBack);
    expect_output_of_page("safety_module");
}

TEST(TourTest, EventLogKeepsTheNewestRecordsAsThePageShows) {
    verifies("SWR-KRN-019", Technique::kBackToBack);
    expect_output_of_page("event_log");
}

TEST(TourTest, IntrospectionShowsTheSystemAsThePageShows) {
    verifies("SWR-INS-001", Technique::kBackToBack);
    expect_output_of_page("introspection");
}

TEST(TourTest, RecorderContinuesItsFileAsThePageShows) {
    verifies("SWR-REC-006", Technique::kBackToBack);
    const std::string file = ::testing::TempDir() + "tour_" + std::to_string(getpid()) + ".rec";
    const std::string shown = read_shown_output("recorder");

    const std::string first = run("recorder", "'" + file + "'");
    const std::string second = run("recorder", "'" + file + "'");
    static_cast<void>(std::remove(file.c_str()));

    ASSERT_FALSE(shown.empty());
    EXPECT_EQ(first + second, shown);
}

}  // namespace
