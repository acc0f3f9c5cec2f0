// SPDX-License-Identifier: Apache-2.0
// Prints the `.lcm` text of the sample types; the build passes it to lcm-gen.
#include "mamori/ports/lcm/type_printer.hpp"
#include "support/sample_types.hpp"

int main() {
    return mamori::ports::lcm::print_lcm_types<lcm_sample::Reading, lcm_sample::Robot, lcm_sample::Cloud,
                                               lcm_sample::CloudMessage>();
}
