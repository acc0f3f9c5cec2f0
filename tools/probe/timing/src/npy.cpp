// SPDX-License-Identifier: Apache-2.0
#include "npy.hpp"

#include "mamori/kernel/base/assert.hpp"

namespace mamori::timing {
namespace {

constexpr std::string_view kMagic{"\x93NUMPY\x01\x00", 8U};
constexpr std::size_t kAlignment = 64U;  ///< of the first row in the file

void append_little_endian(std::string& bytes, std::uint64_t value, std::size_t size) {
    for (std::size_t i = 0U; i < size; ++i) {
        bytes.push_back(static_cast<char>((value >> (8U * i)) & 0xFFU));
    }
}

}  // namespace

void NpyTable::add(std::int64_t value) {
    append_little_endian(bytes_, static_cast<std::uint64_t>(value),
                         fields_[cell_count_ % fields_.size()].size);
    ++cell_count_;
}

std::string NpyTable::make() const {
    MAMORI_REQUIRE(1, cell_count_ % fields_.size() == 0U);
    std::string header = "{'descr': [";
    for (const Field& field : fields_) {
        header += "('" + std::string{field.name} + "', '" + (field.size == 8U ? "<i8" : "<u4") + "'), ";
    }
    header +=
        "], 'fortran_order': False, 'shape': (" + std::to_string(cell_count_ / fields_.size()) + ",), }";
    const std::size_t begin = kMagic.size() + 2U;
    const std::size_t unpadded = begin + header.size() + 1U;
    header.append((kAlignment - unpadded % kAlignment) % kAlignment, ' ');
    header.push_back('\n');
    std::string file{kMagic};
    append_little_endian(file, header.size(), 2U);
    return file + header + bytes_;
}

}  // namespace mamori::timing
