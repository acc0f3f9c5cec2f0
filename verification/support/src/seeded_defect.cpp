// SPDX-License-Identifier: Apache-2.0
#include "mamori/verification/seeded_defect.hpp"

#include <cstring>

namespace mamori::verification {

const char* get_name(Defect defect) noexcept {
    switch (defect) {
        case Defect::kNone:
            return "none";
        case Defect::kLateRelease:
            return "late_release";
        case Defect::kOverrun:
            return "overrun";
        case Defect::kWrongName:
            return "wrong_name";
    }
    return "invalid";
}

bool take_defect(int& count, char** arguments, Defect& defect) noexcept {
    defect = Defect::kNone;
    if (count < 3 || std::strcmp(arguments[count - 2], "--defect") != 0) {
        return true;
    }
    for (std::size_t i = 1U; i < kDefectCount; ++i) {
        const auto candidate = static_cast<Defect>(i);
        if (std::strcmp(arguments[count - 1], get_name(candidate)) == 0) {
            defect = candidate;
            count -= 2;
            return true;
        }
    }
    return false;
}

}  // namespace mamori::verification
