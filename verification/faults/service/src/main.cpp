// SPDX-License-Identifier: Apache-2.0
// lost_service TRIALS SEED [--defect NAME] --out FILE: writes the course of the run. Status 0: complete
// course, 1: no course, 2: wrong arguments.
#include <iostream>

#include "lost_service.hpp"
#include "mamori/verification/course_file.hpp"

int main(int argc, char** argv) {
    using namespace mamori::lost_service;  // NOLINT: this program is made of it
    using mamori::verification::read_number;
    LossRequest request;
    const char* const out = mamori::verification::take_option(argc, argv, "--out");
    if (out == nullptr || !mamori::verification::take_defect(argc, argv, request.defect) ||
        request.defect == mamori::verification::Defect::kWrongName || argc != 3 ||
        !read_number(argv[1], request.trial_count) || !read_number(argv[2], request.seed) ||
        request.trial_count == 0U) {
        std::cerr << "lost_service: expected TRIALS SEED [--defect late_release|overrun] --out FILE: "
                     "integers, at least 1 trial\n";
        return 2;
    }
    const LossRun run = run_losses(request);
    if (run.trials.empty()) {
        std::cerr << "lost_service: the system does not start; check the privileges of this process\n";
        return 1;
    }
    return write_course(request, run, out) ? 0 : 1;
}
