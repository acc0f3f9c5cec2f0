// SPDX-License-Identifier: Apache-2.0
#include "mamori/ports/lcm/type_printer.hpp"

#include <unistd.h>

namespace mamori::ports::lcm {

bool TypePrinter::is_first(std::string_view type) noexcept {
    for (std::size_t i = 0U; i < count_; ++i) {
        if (printed_[i] == type) {
            return false;
        }
    }
    if (count_ == kStructsMax) {
        status_ = Status::kOutOfResources;
        return false;
    }
    printed_[count_] = type;
    ++count_;
    return true;
}

void TypePrinter::print(Result<std::size_t> size) noexcept {
    if (!size.has_value()) {
        status_ = size.get_status();
        return;
    }
    for (std::size_t done = 0U; done < size.get_value();) {
        const ssize_t count = ::write(file_, text_.data() + done, size.get_value() - done);
        if (count <= 0) {
            status_ = Status::kError;
            return;
        }
        done += static_cast<std::size_t>(count);
    }
}

}  // namespace mamori::ports::lcm
