// SPDX-License-Identifier: Apache-2.0
// time_faults FRAMES FAULTS SEED [storm] [--defect NAME]: prints the verdict as JSON. Status 0 passed, 1
// failed, 2 wrong arguments, 4 inconclusive.
#include <charconv>
#include <cstring>
#include <iostream>

#include "mamori/verification/course_file.hpp"
#include "time_faults.hpp"

namespace {

using namespace mamori::time_faults;  // NOLINT: this program is made of it

bool read(const char* text, std::uint64_t& number) {
    const char* const end = text + std::strlen(text);
    const std::from_chars_result result = std::from_chars(text, end, number);
    return result.ec == std::errc{} && result.ptr == end;
}

bool read(int argc, char** argv, Request& request) {
    std::uint64_t faults = 0U;
    if (!mamori::verification::take_defect(argc, argv, request.defect)) {
        return false;
    }
    request.with_storm = argc == 5 && std::strcmp(argv[4], "storm") == 0;
    if ((argc != 4 && !request.with_storm) || !read(argv[1], request.frame_count) || !read(argv[2], faults) ||
        !read(argv[3], request.seed)) {
        return false;
    }
    request.injection_count = faults;
    return request.frame_count != 0U && faults <= request.frame_count / kDistance;
}

}  // namespace

int main(int argc, char** argv) {
    Request request;
    const char* const out = mamori::verification::take_option(argc, argv, "--out");
    if (!read(argc, argv, request)) {
        std::cerr << "time_faults: expected FRAMES FAULTS SEED [storm] [--defect "
                     "late_release|overrun|wrong_name]: integers, at least 1 frame and "
                  << kDistance << " frames for each fault\n";
        return 2;
    }
    const Verdict verdict = run(request, out);
    std::cout << to_json(request, verdict);
    return mamori::verification::get_exit_status(
        mamori::verification::assess_run(verdict.get_evidence()).verdict);
}
