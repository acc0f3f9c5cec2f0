// SPDX-License-Identifier: Apache-2.0
// Prints the message types for `mamori lcm types`.
#include "hil_messages.hpp"
#include "mamori/ports/lcm/type_printer.hpp"

int main() {
    using namespace safe_arm;
    return mamori::ports::lcm::print_lcm_types<DeviceMessage, DriveMessage, StateMessage, CommandMessage>();
}
