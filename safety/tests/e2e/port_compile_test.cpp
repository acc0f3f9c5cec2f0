// SPDX-License-Identifier: Apache-2.0
// Goal: a channel, a message or a port that could not protect does not compile, and the compiler says why.
// Method: the build's own compiler is run on one source, without and with one defect at a time.
#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <string>

#include "mamori/trace/verifies.hpp"

namespace mamori::safety {
namespace {

using namespace verification;

struct Compilation {
    int exit_status{-1};
    std::string messages{};
};

Compilation compile(const std::string& defect) {
    const std::string root{MAMORI_SOURCE_FOLDER};
    const std::string command =
        "LC_ALL=C '" MAMORI_COMPILER "' -std=c++17 -fsyntax-only -Wall -Wextra -Werror -D" + defect + " -I'" +
        root + "/kernel/include' -I'" + root + "/safety/include' '" + root +
        "/safety/tests/compile_fail/e2e_port_source.cpp' 2>&1";
    Compilation result;
    std::FILE* const output = popen(command.c_str(), "r");
    if (output == nullptr) {
        return result;
    }
    std::array<char, 512U> line{};
    while (std::fgets(line.data(), static_cast<int>(line.size()), output) != nullptr) {
        result.messages += line.data();
    }
    const int status = pclose(output);
    result.exit_status = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    return result;
}

void expect_refused(const std::string& defect, const std::string& words) {
    const Compilation result = compile("MAMORI_DEFECT_" + defect);
    EXPECT_EQ(result.exit_status, 1) << defect << '\n' << result.messages;
    EXPECT_NE(result.messages.find(words), std::string::npos) << defect << '\n' << result.messages;
}

TEST(E2ePortCompileTest, SoundSourceCompiles) {
    verifies("SWR-E2E-037");

    const Compilation result = compile("MAMORI_DEFECT_NONE");
    EXPECT_EQ(result.exit_status, 0) << result.messages;
    EXPECT_EQ(result.messages, "");
}

TEST(E2ePortCompileTest, ChannelOfAnUnfitLengthDoesNotCompile) {
    verifies("SWR-E2E-009", Technique::kBoundaryValues, Polarity::kViolation);
    expect_refused("LENGTH", "length does not fit the profile");
    expect_refused("LENGTH_GREATEST", "length does not fit the profile");
}

TEST(E2ePortCompileTest, ChannelWithAMisplacedHeaderDoesNotCompile) {
    verifies("SWR-E2E-009", Technique::kBoundaryValues, Polarity::kViolation);
    expect_refused("OFFSET", "header does not lie where the profile allows it");
    expect_refused("OFFSET_OVERLAP", "header does not lie where the profile allows it");
}

TEST(E2ePortCompileTest, ChannelWithAnUnfitIdentifierDoesNotCompile) {
    verifies("SWR-E2E-009", Technique::kEquivalenceClasses, Polarity::kViolation);
    expect_refused("DATA_ID", "data id has no place in the profile");
}

TEST(E2ePortCompileTest, ChannelThatAStuckLineFitsDoesNotCompile) {
    verifies("SWR-E2E-009", Technique::kErrorGuessing, Polarity::kViolation);
    expect_refused("STUCK", "line stuck at 0 or 1 would be a good frame");
}

TEST(E2ePortCompileTest, UnfitLimitsOfEachOrderDoNotCompile) {
    verifies("SWR-E2E-009", Technique::kBoundaryValues, Polarity::kViolation);
    expect_refused("LIMITS_PLAIN", "limits of the counter are out of range");
    expect_refused("LIMITS_SYNCHRONISING", "limits of the counter are out of range");
    expect_refused("LIMITS_HARDENED", "limits of the counter are out of range");
}

TEST(E2ePortCompileTest, MessageOfAnUnsoundChannelDoesNotCompile) {
    verifies("SWR-E2E-037", Technique::kErrorGuessing, Polarity::kViolation);
    expect_refused("MESSAGE_CHANNEL", "header does not lie where the profile allows it");
}

TEST(E2ePortCompileTest, ChannelOfOtherLengthsThanThoseOfTheMessageDoesNotCompileAndTheyAreNamed) {
    verifies("SWR-E2E-037", Technique::kBoundaryValues, Polarity::kViolation);
    expect_refused("MESSAGE_SHORTEST", "lengths of the channel are not those of the message");
    expect_refused("MESSAGE_SHORTEST", "ChannelTakesFramesOf<false, 24, 28>");
    expect_refused("MESSAGE_LONGEST", "ChannelTakesFramesOf<false, 24, 28>");
}

TEST(E2ePortCompileTest, PayloadOfChangingSizeNeedsALengthField) {
    verifies("SWR-E2E-037", Technique::kErrorGuessing, Polarity::kViolation);
    expect_refused("MESSAGE_WITHOUT_LENGTH_FIELD",
                   "a profile without length field needs a payload of one size");
}

TEST(E2ePortCompileTest, PayloadWithoutFieldsDoesNotCompile) {
    verifies("SWR-E2E-037", Technique::kErrorGuessing, Polarity::kViolation);
    expect_refused("MESSAGE_PAYLOAD", "give this type a field list");
}

TEST(E2ePortCompileTest, PortWithoutAnAgeDoesNotCompile) {
    verifies("SWR-E2E-037", Technique::kBoundaryValues, Polarity::kViolation);
    expect_refused("PORT_AGE", "a value needs an age that it may reach");
}

TEST(E2ePortCompileTest, PortWithUnsoundLimitsDoesNotCompile) {
    verifies("SWR-E2E-037", Technique::kBoundaryValues, Polarity::kViolation);
    expect_refused("PORT_ORDER", "limits of the counter are out of range");
    expect_refused("PORT_WINDOW", "demands on the channel's window are unsound");
    expect_refused("PORT_DEMANDS", "demands on the channel's window are unsound");
}

TEST(E2ePortCompileTest, PortWithoutRoomForTheMessageDoesNotCompile) {
    verifies("SWR-E2E-037", Technique::kBoundaryValues, Polarity::kViolation);
    expect_refused("PORT_OUT_ROOM", "frames of the port have no room for the message");
    expect_refused("PORT_IN_ROOM", "frames of the port have no room for the message");
}

TEST(E2ePortCompileTest, PortWithoutASubstituteOrWithItsVerdictIgnoredDoesNotCompile) {
    verifies("SWR-E2E-032", Technique::kErrorGuessing, Polarity::kViolation);
    expect_refused("PORT_WITHOUT_SUBSTITUTE", "no matching");
    expect_refused("WORTH_IGNORED", "nodiscard");
}

}  // namespace
}  // namespace mamori::safety
