// SPDX-License-Identifier: Apache-2.0
/// @file
/// For tests of what must not compile: runs the build's own compiler on a source of this folder.
#ifndef MAMORI_SAFETY_TESTS_COMPILE_FAIL_COMPILER_HPP
#define MAMORI_SAFETY_TESTS_COMPILE_FAIL_COMPILER_HPP

#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <string>

namespace mamori::safety::rig {

/// What the compiler answered. Exit status -1: it could not be run.
struct Compilation {
    int exit_status{-1};
    std::string messages{};

    bool names(const std::string& text) const { return messages.find(text) != std::string::npos; }
};

/// @param[in] source file in this folder. @param[in] defect macro that brings one defect in.
inline Compilation compile(const std::string& source, const std::string& defect) {
    const std::string root{MAMORI_SOURCE_FOLDER};
    const std::string command = "LC_ALL=C '" MAMORI_COMPILER "' -std=c++17 -fsyntax-only -Wno-unused -D" +
                                defect + " -I'" + root + "/kernel/include' -I'" + root +
                                "/safety/include' '" + root + "/safety/tests/compile_fail/" + source +
                                "' 2>&1";
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

}  // namespace mamori::safety::rig

#endif  // MAMORI_SAFETY_TESTS_COMPILE_FAIL_COMPILER_HPP
