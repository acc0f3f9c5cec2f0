// SPDX-License-Identifier: Apache-2.0
/// @file
/// Writes the course of a fault campaign: all records of a run, as one JSON object of the schema
/// mamori.fault_course/1. `verification/faults/evaluation` reads and evaluates it.
///
/// Design: docs/design/test_strength.md#courses
#ifndef MAMORI_VERIFICATION_COURSE_FILE_HPP
#define MAMORI_VERIFICATION_COURSE_FILE_HPP

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <string>
#include <vector>

#include "mamori/verification/stall_watch.hpp"

namespace mamori::verification {

/// One column of a table: its name and the value of each row.
template <typename Row>
struct Column {
    const char* name;
    std::int64_t (*get)(const Row& row);
};

/// Thread safety: none. Memory: heap; the complete text is stored until write().
class CourseFile final {
  public:
    /// @param[in] subject name of the campaign, for example "service".
    explicit CourseFile(const char* subject);

    void add(const char* key, std::int64_t value) { add_text(key, std::to_string(value)); }
    void add(const char* key, std::uint64_t value) { add_text(key, std::to_string(value)); }
    void add(const char* key, bool value) { add_text(key, value ? "true" : "false"); }
    void add(const char* key, const char* value) { add_text(key, '"' + std::string{value} + '"'); }
    /// Names of an enumeration, in its order.
    void add(const char* key, std::initializer_list<const char*> names);
    void add(const char* key, const HostFigures& host);
    void add(const char* key, const std::vector<Stall>& spans);
    /// A table by columns. Each value is the difference from the previous row; the first row is the
    /// difference from 0.
    template <typename Row>
    void add(const char* key, const std::vector<Row>& rows, std::initializer_list<Column<Row>> columns) {
        begin_table(key);
        for (const Column<Row>& column : columns) {
            begin_column(column.name);
            std::int64_t before = 0;
            for (const Row& row : rows) {
                const std::int64_t value = column.get(row);
                add_difference(value - before);
                before = value;
            }
            text_ += ']';
        }
        text_ += '}';
    }

    /// Replaces the file by the complete text. @return false after one line on stderr; an old file is then
    /// unchanged.
    bool write(const char* path) const;

  private:
    void add_text(const char* key, const std::string& value);
    void begin_table(const char* key) { add_text(key, "{"); }
    void begin_column(const char* name);
    void add_difference(std::int64_t value);

    std::string text_;
};

/// Removes `NAME VALUE` from the end of the arguments. @param[in,out] count of the arguments.
/// @return the value; nullptr if the arguments do not end in this option.
const char* take_option(int& count, char** arguments, const char* name) noexcept;

/// @return false if `text` is not an integer from 0 to 2^64 - 1.
bool read_number(const char* text, std::uint64_t& number) noexcept;

}  // namespace mamori::verification

#endif  // MAMORI_VERIFICATION_COURSE_FILE_HPP
