// SPDX-License-Identifier: Apache-2.0
// Goal: the log of a real run over LCM replays to the outputs of that run, and each time to the same ones.
// Method: a system receives over multicast in a network namespace, which needs root, while lcm-logger
// records; its replay mode then runs with the log.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "mamori/trace/verifies.hpp"

namespace {

using namespace mamori::verification;

constexpr int kCount = 100;
constexpr int kNotPossible = 77;

/// Runs a shell script. @return its exit status.
int run(const std::string& script) {
    const int status = std::system(script.c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

class LcmReplayTest : public ::testing::Test {
  protected:
    void SetUp() override { std::filesystem::create_directories(folder_); }
    void TearDown() override { std::filesystem::remove_all(folder_); }

    std::string read(const std::string& name) const {
        std::ifstream in(folder_ + "/" + name);
        return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
    }
    int replay(const std::string& output) const {
        return run(program_ + " --replay " + folder_ + "/log > " + folder_ + "/" + output + " 2>&1");
    }
    static std::string get_last_line(const std::string& text) {
        const std::size_t begin = text.size() < 2U ? std::string::npos : text.rfind('\n', text.size() - 2U);
        return begin == std::string::npos ? text : text.substr(begin + 1U);
    }

    std::string program_{MAMORI_REPLAY_PROGRAM};
    std::string folder_{::testing::TempDir() + "mamori_lcm_replay_" + std::to_string(::getpid())};
};

TEST_F(LcmReplayTest, TheLogOfARealRunReplaysToTheOutputsOfThatRun) {
    verifies("SWR-LCM-015", Technique::kBackToBack, Polarity::kNominal);
    // The receiver and the logger are ready when both have a socket on the port of LCM (7667, hexadecimal
    // 1DF3).
    std::ofstream(folder_ + "/script")
        << "command -v ip lcm-logger > /dev/null || exit 77\n"
        << "ip link set lo up multicast on && ip route add 224.0.0.0/4 dev lo || exit 77\n"
        << "cd " << folder_ << "\n"
        << "lcm-logger --lcm-url='udpm://239.255.76.67:7667?ttl=0' log > logger 2>&1 & logger=$!\n"
        << program_ << " run " << kCount << " > run & run=$!\n"
        << "for i in $(seq 1000); do\n"
        << "    grep -q receiving run && [ $(grep -c ':1DF3 ' /proc/net/udp) -ge 2 ] && break; sleep 0.01\n"
        << "done\n"
        << program_ << " send " << kCount << " || exit 1\n"
        << "wait $run; status=$?; kill -INT $logger; wait $logger; exit $status\n";
    const int status = run("unshare -n sh " + folder_ + "/script 2> " + folder_ + "/errors");
    if (status == kNotPossible || ::geteuid() != 0U) {
        GTEST_SKIP() << "verdict=not-shown: needs root, ip and lcm-logger";
    }
    ASSERT_EQ(status, 0) << read("errors") << read("logger");

    ASSERT_EQ(replay("first"), 0) << read("first");
    ASSERT_EQ(replay("second"), 0) << read("second");

    EXPECT_EQ(read("first"), read("second"));
    const std::string text = read("first");
    EXPECT_NE(text.find("channel STATE: used " + std::to_string(kCount - 2) +
                        ", lost 0, damaged 0, unordered 0, initial 2,"),
              std::string::npos)
        << text;
    EXPECT_NE(text.find("core 0: trace hash "), std::string::npos) << text;
    const std::string real = read("run");
    if (real.find("states " + std::to_string(kCount - 2) + ",") == std::string::npos) {
        GTEST_SKIP() << "verdict=inconclusive: the host stopped the real run for more than 20 ms: " << real;
    }
    EXPECT_EQ(get_last_line(text), get_last_line(real));
}

TEST_F(LcmReplayTest, ADamagedLogEndsWithItsOffset) {
    verifies("SWR-LCM-015", Technique::kFaultInjection, Polarity::kViolation);
    std::ofstream(folder_ + "/log", std::ios::binary) << std::string("\xED\xA1\xDA\x01", 4U) +
                                                             std::string(19U, '\0') + "\x05" +
                                                             std::string(4U, '\0') + "STATE" + "x";

    EXPECT_EQ(replay("text"), 1);

    const std::string text = read("text");
    EXPECT_NE(text.find("log: damaged at offset 33; the events before it were replayed"), std::string::npos)
        << text;
    EXPECT_NE(text.find("truncated 1"), std::string::npos) << text;
}

TEST_F(LcmReplayTest, AFileThatIsNotALogIsRejected) {
    verifies("SWR-LCM-015", Technique::kEquivalenceClasses, Polarity::kViolation);
    std::ofstream(folder_ + "/log") << "hello";

    EXPECT_EQ(replay("text"), 2);

    EXPECT_NE(read("text").find("is not a log of lcm-logger"), std::string::npos);
}

}  // namespace
