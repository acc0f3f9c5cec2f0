// SPDX-License-Identifier: Apache-2.0
/// @file
/// Reads a YAML map strictly: known keys only, each once, each figure with its origin, each number in its
/// range. The first defect ends the reading with a ReadError that names file, line, place and key.
#ifndef MAMORI_SIMBODY_SIM_SRC_FIGURE_READER_HPP
#define MAMORI_SIMBODY_SIM_SRC_FIGURE_READER_HPP

#include <yaml-cpp/yaml.h>

#include <array>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace mamori::sim::detail {

/// One line: `<file>:<line>: <place>: <what is wrong>`. Stays inside the library.
class ReadError final : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

/// Numbers that a figure may have.
struct Range {
    double min;
    bool min_allowed;
    double max;
};
inline constexpr double kLargest = 1.0e9;
inline constexpr Range kAny{-kLargest, true, kLargest};
inline constexpr Range kPositive{0.0, false, kLargest};
inline constexpr Range kNotNegative{0.0, true, kLargest};
inline constexpr Range kDelay{0.0, true, 10.0};

/// One map of the file.
class FigureReader final {
  public:
    /// @param[in] keys all keys that the map has; each must be there, no other may. Throws ReadError.
    /// @param[in] place what errors call the map, for example "joint J2"; may be empty.
    FigureReader(const YAML::Node& map, std::string file, std::string place,
                 const std::vector<std::string_view>& keys);

    /// Text that is not empty.
    std::string read_text(const char* key) const;
    /// Figure: a map of `value` and one of `source` and `assumption`, a text.
    double read_number(const char* key, Range range) const;
    template <std::size_t N>
    std::array<double, N> read_numbers(const char* key, Range range) const {
        const std::vector<double> numbers = read_list(key, N, range);
        std::array<double, N> result{};
        for (std::size_t i = 0U; i < N; ++i) {
            result[i] = numbers[i];
        }
        return result;
    }
    /// @param[in] place what errors add for the map under `key`.
    FigureReader read_map(const char* key, const std::string& place,
                          const std::vector<std::string_view>& keys) const;
    /// List of exactly `size` elements.
    YAML::Node read_sequence(const char* key, std::size_t size) const;

    /// Refuses the figure under `key` for a reason that only its user can know.
    [[noreturn]] void refuse(const char* key, const std::string& reason) const;

  private:
    YAML::Node read_figure_value(const char* key) const;
    std::vector<double> read_list(const char* key, std::size_t size, Range range) const;
    double to_number(const YAML::Node& node, const char* key, Range range) const;
    [[noreturn]] void fail(const YAML::Node& node, const std::string& what) const;

    YAML::Node map_;
    std::string file_;
    std::string place_;
};

}  // namespace mamori::sim::detail

#endif  // MAMORI_SIMBODY_SIM_SRC_FIGURE_READER_HPP
