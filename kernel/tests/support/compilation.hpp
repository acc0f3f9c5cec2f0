// SPDX-License-Identifier: Apache-2.0
/// @file
/// Compiles the sources of tests/compile_fail with the compiler of this build: as they are, which must
/// succeed (so a case breaks nothing else), and with one case broken, which must fail with the expected
/// words.
#ifndef MAMORI_KERNEL_TESTS_COMPILATION_HPP
#define MAMORI_KERNEL_TESTS_COMPILATION_HPP

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <array>
#include <cctype>
#include <cstdio>
#include <map>
#include <string>

namespace mamori::testing_support {

struct Compilation {
    bool has_succeeded{false};
    std::string output;
};

inline Compilation compile(const std::string& name, const std::string& option) {
    const std::string command = std::string("'") + MAMORI_TEST_COMPILER +
                                "' -std=c++17 -fsyntax-only -fno-exceptions -fno-rtti -Wall -Werror " +
                                option + " -I'" + MAMORI_TEST_INCLUDE + "' '" + MAMORI_TEST_CASES + "/" +
                                name + ".cpp' 2>&1";
    Compilation result;
    FILE* pipe = popen(command.c_str(), "r");
    if (pipe == nullptr) {
        result.output = "cannot run: " + command;
        return result;
    }
    std::array<char, 4096> buffer{};
    while (std::fgets(buffer.data(), static_cast<int>(buffer.size()), pipe) != nullptr) {
        result.output += buffer.data();
    }
    const int status = pclose(pipe);
    // A compiler that could not be found or that crashed is no refusal.
    if (!WIFEXITED(status) || WEXITSTATUS(status) > 1) {
        ADD_FAILURE() << "the compiler did not do its work: " << command << "\n" << result.output;
    }
    result.has_succeeded = WIFEXITED(status) && WEXITSTATUS(status) == 0;
    return result;
}

/// The macro that breaks one case of a source.
inline std::string name_macro(const std::string& defect) {
    std::string name = "-DMAMORI_BREAK";
    if (!defect.empty()) {
        name += '_';
    }
    for (const char letter : defect) {
        name += static_cast<char>(std::toupper(static_cast<unsigned char>(letter)));
    }
    return name;
}

/// The source compiles as it is, and is refused with `expected` in the message when one case is broken.
/// @param defect the case; empty for a source of one case. @param value of the macro, where it has one.
inline void expect_refused(const std::string& source, const std::string& defect, const std::string& expected,
                           const std::string& value = "") {
    static std::map<std::string, Compilation> controls;
    if (controls.count(source) == 0U) {
        controls[source] = compile(source, "");
    }
    const Compilation& control = controls[source];
    const Compilation broken = compile(source, name_macro(defect) + (value.empty() ? "" : "=" + value));

    ASSERT_TRUE(control.has_succeeded) << control.output;
    EXPECT_FALSE(broken.has_succeeded);
    EXPECT_NE(broken.output.find(expected), std::string::npos) << "expected: " << expected << "\n"
                                                               << broken.output;
}

}  // namespace mamori::testing_support

#endif  // MAMORI_KERNEL_TESTS_COMPILATION_HPP
