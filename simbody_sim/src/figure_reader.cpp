// SPDX-License-Identifier: Apache-2.0
#include "figure_reader.hpp"

#include <algorithm>
#include <utility>

#include "mamori/simbody_sim/nearest_name.hpp"
#include "number_text.hpp"

namespace mamori::sim::detail {
namespace {

std::string describe(Range range) {
    const std::string lower = (range.min_allowed ? "at least " : "greater than ") + to_text(range.min);
    return lower + " and at most " + to_text(range.max);
}

bool is_inside(double number, Range range) noexcept {
    return (range.min_allowed ? number >= range.min : number > range.min) && number <= range.max;
}

}  // namespace

FigureReader::FigureReader(const YAML::Node& map, std::string file, std::string place,
                           const std::vector<std::string_view>& keys)
    : map_(map), file_(std::move(file)), place_(std::move(place)) {
    if (!map_.IsMap()) {
        fail(map_, "must be a map of keys and values");
    }
    std::vector<std::string> seen;
    for (const auto& entry : map_) {
        if (!entry.first.IsScalar()) {
            fail(entry.first, "a key must be a plain word");
        }
        const std::string& key = entry.first.Scalar();
        if (std::find(keys.begin(), keys.end(), key) == keys.end()) {
            fail(entry.first, "unknown key '" + key + "'; did you mean '" +
                                  std::string(find_nearest_name(key, keys)) + "'?");
        }
        if (std::find(seen.begin(), seen.end(), key) != seen.end()) {
            fail(entry.first, key + ": is given twice");
        }
        seen.push_back(key);
    }
    for (const std::string_view key : keys) {
        if (std::find(seen.begin(), seen.end(), key) == seen.end()) {
            fail(map_, std::string(key) + ": is missing");
        }
    }
}

std::string FigureReader::read_text(const char* key) const {
    const YAML::Node node = map_[key];
    if (!node.IsScalar() || node.Scalar().empty()) {
        fail(node, std::string(key) + ": must be a text");
    }
    return node.Scalar();
}

double FigureReader::read_number(const char* key, Range range) const {
    return to_number(read_figure_value(key), key, range);
}

FigureReader FigureReader::read_map(const char* key, const std::string& place,
                                    const std::vector<std::string_view>& keys) const {
    return {map_[key], file_, place_.empty() ? place : place_ + ": " + place, keys};
}

YAML::Node FigureReader::read_sequence(const char* key, std::size_t size) const {
    const YAML::Node node = map_[key];
    if (!node.IsSequence() || node.size() != size) {
        fail(node, std::string(key) + ": must be a list of " + std::to_string(size) + " elements" +
                       (node.IsSequence() ? ", has " + std::to_string(node.size()) : std::string()));
    }
    return node;
}

void FigureReader::refuse(const char* key, const std::string& reason) const {
    fail(map_[key], std::string(key) + ": " + reason);
}

YAML::Node FigureReader::read_figure_value(const char* key) const {
    const YAML::Node figure = map_[key];
    const std::string name(key);
    if (!figure.IsMap()) {
        fail(
            figure,
            name + ": must be written as {value: ..., source: \"...\"} or {value: ..., assumption: \"...\"}");
    }
    std::size_t origins = 0U;
    for (const auto& entry : figure) {
        const std::string part = entry.first.IsScalar() ? entry.first.Scalar() : std::string("?");
        if (part == "source" || part == "assumption") {
            ++origins;
            if (!entry.second.IsScalar() || entry.second.Scalar().empty()) {
                fail(entry.second, name + ": its " + part + " must be a text");
            }
        } else if (part != "value") {
            fail(entry.first,
                 name + ": unknown key '" + part + "'; a figure has 'value' and 'source' or 'assumption'");
        }
    }
    if (origins != 1U) {
        fail(figure,
             name + (origins == 0U ? ": needs a source or an assumption" : ": has more than one origin"));
    }
    const YAML::Node value = figure["value"];
    if (!value.IsDefined()) {
        fail(figure, name + ": its value is missing");
    }
    return value;
}

std::vector<double> FigureReader::read_list(const char* key, std::size_t size, Range range) const {
    const YAML::Node value = read_figure_value(key);
    if (!value.IsSequence() || value.size() != size) {
        fail(value, std::string(key) + ": must be a list of " + std::to_string(size) + " numbers" +
                        (value.IsSequence() ? ", has " + std::to_string(value.size()) : std::string()));
    }
    std::vector<double> numbers;
    for (const YAML::Node& element : value) {
        numbers.push_back(to_number(element, key, range));
    }
    return numbers;
}

double FigureReader::to_number(const YAML::Node& node, const char* key, Range range) const {
    const std::string name(key);
    if (!node.IsScalar()) {
        fail(node, name + ": must be one number");
    }
    double number = 0.0;
    if (!try_parse_number(node.Scalar(), number)) {
        fail(node, name + ": must be a finite number, is '" + node.Scalar() + "'");
    }
    if (!is_inside(number, range)) {
        fail(node, name + ": must be " + describe(range) + ", is " + node.Scalar());
    }
    return number;
}

void FigureReader::fail(const YAML::Node& node, const std::string& what) const {
    const int line = node.IsDefined() ? node.Mark().line : map_.Mark().line;
    throw ReadError(file_ + ":" + std::to_string(line + 1) + ": " + (place_.empty() ? "" : place_ + ": ") +
                    what);
}

}  // namespace mamori::sim::detail
