// SPDX-License-Identifier: Apache-2.0
/// @file
/// Writes rows as a NumPy structured array.
/// Source: NumPy Enhancement Proposal 1, "A Simple File Format for NumPy Arrays", format version 1.0
#ifndef MAMORI_TIMING_NPY_HPP
#define MAMORI_TIMING_NPY_HPP

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace mamori::timing {

/// Table of integers, in memory as in the file: little endian, rows without gaps.
class NpyTable final {
  public:
    struct Field {
        std::string_view name;
        std::size_t size;  ///< [byte] 4: unsigned; 8: signed
    };

    explicit NpyTable(std::vector<Field> fields) : fields_(std::move(fields)) {}

    /// Adds the next cell of the row, in the order of the fields.
    void add(std::int64_t value);
    /// @return the complete file. @pre all rows are complete.
    std::string make() const;

  private:
    std::vector<Field> fields_;
    std::string bytes_;
    std::size_t cell_count_{0U};
};

}  // namespace mamori::timing

#endif  // MAMORI_TIMING_NPY_HPP
