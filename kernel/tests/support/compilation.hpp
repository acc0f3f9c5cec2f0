// SPDX-License-Identifier: Apache-2.0
/// @file
/// Compiles the sources of tests/compile_fail with the compiler of this build: as they are, which must
/// succeed (so a case breaks nothing else), and with one case broken, which must fail and name the faulty
/// element in the first five lines of the message.
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

/// The first five lines of what the compiler says.
inline std::string take_head(const std::string& output) {
    std::size_t end = 0U;
    for (int line = 0; line < 5 && end != std::string::npos; ++line) {
        end = output.find('\n', end == 0U ? 0U : end + 1U);
    }
    return output.substr(0U, end);
}

inline const Compilation& compile_control(const std::string& source) {
    static std::map<std::string, Compilation> controls;
    if (controls.count(source) == 0U) {
        controls[source] = compile(source, "");
    }
    return controls[source];
}

/// The source compiles as it is, and is refused when one case is broken.
/// @return the output. @param defect the case; empty for a source of one case. @param value of the macro,
/// where it has one.
inline std::string refuse(const std::string& source, const std::string& defect, const std::string& value) {
    const Compilation& control = compile_control(source);
    EXPECT_TRUE(control.has_succeeded) << control.output;
    const Compilation broken = compile(source, name_macro(defect) + (value.empty() ? "" : "=" + value));
    EXPECT_FALSE(broken.has_succeeded);
    return broken.output;
}

/// The same, and the message names `element` in its first five lines.
inline void expect_refused(const std::string& source, const std::string& defect, const std::string& element,
                           const std::string& value = "") {
    const std::string output = refuse(source, defect, value);

    EXPECT_NE(take_head(output).find(element), std::string::npos) << "expected: " << element << "\n"
                                                                  << output;
}

/// The same for words that are anywhere in the message, since the compiler puts its own lines first.
inline void expect_explained(const std::string& source, const std::string& defect, const std::string& words,
                             const std::string& value = "") {
    const std::string output = refuse(source, defect, value);

    EXPECT_NE(output.find(words), std::string::npos) << "expected: " << words << "\n" << output;
}

}  // namespace mamori::testing_support

#endif  // MAMORI_KERNEL_TESTS_COMPILATION_HPP
