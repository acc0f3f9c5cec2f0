// SPDX-License-Identifier: Apache-2.0
// lost_service TRIALS SEED [--defect NAME]: prints the verdict as JSON. Status 0 passed, 1 failed, 2 wrong
// arguments, 4 inconclusive.
#include <charconv>
#include <cstring>
#include <iostream>

#include "lost_service.hpp"
#include "mamori/verification/course_file.hpp"

namespace {

bool read_number(const char* text, std::uint64_t& number) {
    const char* const end = text + std::strlen(text);
    const std::from_chars_result result = std::from_chars(text, end, number);
    return result.ec == std::errc{} && result.ptr == end;
}

}  // namespace

int main(int argc, char** argv) {
    using namespace mamori::lost_service;  // NOLINT: this program is made of it
    LossRequest request;
    const char* const out = mamori::verification::take_option(argc, argv, "--out");
    if (!mamori::verification::take_defect(argc, argv, request.defect) ||
        request.defect == mamori::verification::Defect::kWrongName || argc != 3 ||
        !read_number(argv[1], request.trial_count) || !read_number(argv[2], request.seed) ||
        request.trial_count == 0U) {
        std::cerr << "lost_service: expected TRIALS SEED [--defect late_release|overrun]: integers, at least "
                     "1 trial\n";
        return 2;
    }
    const LossRun run = run_losses(request);
    std::cout << to_json(request, run);
    if (out != nullptr && !write_course(request, run, out)) {
        return 2;
    }
    return mamori::verification::get_exit_status(
        mamori::verification::assess_run(run.get_evidence()).verdict);
}
