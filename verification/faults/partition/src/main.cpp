// SPDX-License-Identifier: Apache-2.0
// partition_faults FAULTS SEED [--defect NAME]: prints the verdict as JSON. Status 0 passed, 1 failed, 2
// wrong arguments, 4 inconclusive.
#include <charconv>
#include <cstring>
#include <iostream>

#include "campaign.hpp"
#include "mamori/verification/course_file.hpp"

namespace {

bool read(const char* text, std::uint64_t& number) {
    const char* const end = text + std::strlen(text);
    const std::from_chars_result result = std::from_chars(text, end, number);
    return result.ec == std::errc{} && result.ptr == end;
}

}  // namespace

int main(int argc, char** argv) {
    using namespace mamori::partition_faults;  // NOLINT: all of it
    CampaignRequest request{0U, 1U, MAMORI_PARTITION_WORKER, {}};
    const char* const out = mamori::verification::take_option(argc, argv, "--out");
    if (!mamori::verification::take_defect(argc, argv, request.defect) || argc != 3 ||
        !read(argv[1], request.fault_count) || !read(argv[2], request.seed) || request.fault_count == 0U ||
        request.fault_count > kFaultsMax) {
        std::cerr << "partition_faults: expected FAULTS SEED [--defect late_release|overrun|wrong_name]: "
                     "integers, 1 to "
                  << kFaultsMax << " faults\n";
        return 2;
    }
    const Verdict verdict = run(request, out);
    std::cout << to_json(request, verdict);
    if (!verdict.has_priority) {
        std::cerr
            << "partition_faults: without a fixed priority any thread of the machine moves the windows; "
               "run as root or give the program CAP_SYS_NICE\n";
    }
    return mamori::verification::get_exit_status(
        mamori::verification::assess_run(verdict.get_evidence()).verdict);
}
