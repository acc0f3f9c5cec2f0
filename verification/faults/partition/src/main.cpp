// SPDX-License-Identifier: Apache-2.0
// partition_faults FAULTS SEED [--defect NAME] --out FILE: writes the course of the run. Status 0: complete
// course, 1: no course, 2: wrong arguments.
#include <iostream>

#include "campaign.hpp"
#include "mamori/verification/course_file.hpp"

int main(int argc, char** argv) {
    using namespace mamori::partition_faults;  // NOLINT: all of it
    using mamori::verification::read_number;
    CampaignRequest request{0U, 1U, MAMORI_PARTITION_WORKER, {}};
    const char* const out = mamori::verification::take_option(argc, argv, "--out");
    if (out == nullptr || !mamori::verification::take_defect(argc, argv, request.defect) || argc != 3 ||
        !read_number(argv[1], request.fault_count) || !read_number(argv[2], request.seed) ||
        request.fault_count == 0U || request.fault_count > kFaultsMax) {
        std::cerr
            << "partition_faults: expected FAULTS SEED [--defect late_release|overrun|wrong_name] --out "
               "FILE: integers, 1 to "
            << kFaultsMax << " faults\n";
        return 2;
    }
    return write_course(request, run(request), out) ? 0 : 1;
}
