// SPDX-License-Identifier: Apache-2.0
#include "mamori/simbody_sim/nearest_name.hpp"

#include <algorithm>
#include <cstddef>
#include <numeric>

namespace mamori::sim {
namespace {

/// Levenshtein distance, row by row.
std::size_t calc_edit_distance(std::string_view a, std::string_view b) {
    std::vector<std::size_t> row(b.size() + 1U);
    std::iota(row.begin(), row.end(), std::size_t{0U});
    for (std::size_t i = 0U; i < a.size(); ++i) {
        std::size_t diagonal = row[0];
        row[0] = i + 1U;
        for (std::size_t j = 0U; j < b.size(); ++j) {
            const std::size_t replaced = diagonal + (a[i] == b[j] ? 0U : 1U);
            diagonal = row[j + 1U];
            row[j + 1U] = std::min({replaced, row[j] + 1U, diagonal + 1U});
        }
    }
    return row.back();
}

}  // namespace

std::string_view find_nearest_name(std::string_view word, const std::vector<std::string_view>& names) {
    return *std::min_element(names.begin(), names.end(), [word](std::string_view a, std::string_view b) {
        return calc_edit_distance(word, a) < calc_edit_distance(word, b);
    });
}

}  // namespace mamori::sim
