// SPDX-License-Identifier: Apache-2.0
// time_faults FRAMES FAULTS SEED [storm] [--defect NAME] --out FILE: writes the course of the run. Status 0:
// complete course, 1: no course, 2: wrong arguments.
#include <cstring>
#include <iostream>

#include "mamori/verification/course_file.hpp"
#include "time_faults.hpp"

namespace {

using namespace mamori::time_faults;  // NOLINT: this program is made of it

bool read(int argc, char** argv, Request& request) {
    using mamori::verification::read_number;
    std::uint64_t faults = 0U;
    if (!mamori::verification::take_defect(argc, argv, request.defect)) {
        return false;
    }
    request.with_storm = argc == 5 && std::strcmp(argv[4], "storm") == 0;
    if ((argc != 4 && !request.with_storm) || !read_number(argv[1], request.frame_count) ||
        !read_number(argv[2], faults) || !read_number(argv[3], request.seed)) {
        return false;
    }
    request.injection_count = faults;
    return request.frame_count != 0U && faults <= request.frame_count / kDistance;
}

}  // namespace

int main(int argc, char** argv) {
    Request request;
    const char* const out = mamori::verification::take_option(argc, argv, "--out");
    if (out == nullptr || !read(argc, argv, request)) {
        std::cerr << "time_faults: expected FRAMES FAULTS SEED [storm] [--defect "
                     "late_release|overrun|wrong_name] --out FILE: integers, at least 1 frame and "
                  << kDistance << " frames for each fault\n";
        return 2;
    }
    const Course course = run(request);
    if (!course.has_run) {
        std::cerr << "time_faults: the system does not start; check the privileges of this process\n";
        return 1;
    }
    return write_course(request, course, out) ? 0 : 1;
}
