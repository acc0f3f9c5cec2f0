// SPDX-License-Identifier: Apache-2.0
/// @file
/// Death tests that pass only if the stated check ends the program. A crash, another check or another exit
/// fails the test.
///
/// @satisfies SWR-VER-024      Design: docs/design/test_strength.md#death-tests
#ifndef MAMORI_VERIFICATION_FAILED_CHECK_HPP
#define MAMORI_VERIFICATION_FAILED_CHECK_HPP

#include <gtest/gtest.h>

#include <csignal>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "mamori/kernel/base/assert.hpp"

namespace mamori::verification {

/// Assertion handler: writes one line that identifies the check, and aborts.
inline void print_failed_check(const AssertionRecord& record) noexcept {
    std::fprintf(stderr, "%s: check %u failed\n", record.file, static_cast<unsigned>(record.id));
    std::abort();
}

/// @param[in] file name of the file, preceded by as many folders as are needed to identify it.
/// @return regular expression (POSIX, extended) for the line of check `Id` of `file`.
template <std::uint32_t Id, std::size_t N>
std::string make_check_pattern(const char (&file)[N]) {
    static_assert(Id > 0U, "specify the number of the check; the first one is 1");
    static_assert(N > 1U, "specify the file of the check, for example \"span.hpp\"");
    std::string pattern{"(^|[/\n])"};
    for (const char* character = file; *character != '\0'; ++character) {
        pattern += *character == '.' ? std::string{"[.]"} : std::string{*character};
    }
    return pattern + ": check " + std::to_string(Id) + " failed\n";
}

}  // namespace mamori::verification

/// Expects that `statement` ends in check `id` (a constant) of `file` (a literal). A child process runs the
/// statement. The name follows the macros of GoogleTest, because usage is the same.
#define EXPECT_CHECK_FAILS(statement, file, id)                                           \
    EXPECT_EXIT(                                                                          \
        {                                                                                 \
            ::mamori::set_assertion_handler(&::mamori::verification::print_failed_check); \
            statement;                                                                    \
        },                                                                                \
        ::testing::KilledBySignal(SIGABRT), ::mamori::verification::make_check_pattern<(id)>(file))

#endif  // MAMORI_VERIFICATION_FAILED_CHECK_HPP
