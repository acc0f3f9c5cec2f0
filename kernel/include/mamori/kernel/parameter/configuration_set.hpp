// SPDX-License-Identifier: Apache-2.0
/// @file
/// Named sets of parameter values, as compile-time constants that the compiler checks:
///
///     constexpr auto kConfiguration = mamori::configuration(
///         mamori::parameters_of(monitor, supervisor),
///         mamori::configuration_set("normal", mamori::assign(monitor.limit_rad_s, 1.5)),
///         mamori::configuration_set("slow", mamori::assign(monitor.limit_rad_s, 0.5)));
///     MAMORI_CHECK_CONFIGURATION(kConfiguration);
///
/// When a set becomes active, a parameter that the set does not assign keeps its value.
///
/// @satisfies SWR-PAR-006      Design: docs/design/parameters.md#configuration-sets
/// Source:   OpenRTM-aist and OMG Super Distributed Objects, ConfigurationSet
#ifndef MAMORI_KERNEL_CONFIGURATION_SET_HPP
#define MAMORI_KERNEL_CONFIGURATION_SET_HPP

#include <array>
#include <cstddef>

#include "mamori/kernel/parameter/configuration_check.hpp"
#include "mamori/kernel/parameter/configuration_table.hpp"
#include "mamori/kernel/parameter/parameter.hpp"
#include "mamori/kernel/parameter/parameter_list.hpp"

namespace mamori {

/// Value of one parameter in a set.
template <std::size_t kElements>
struct Assignment {
    ParameterBase* parameter;
    std::array<Scalar, kElements> values;
};

/// One set, before it is added to a table.
template <std::size_t kAssignments, std::size_t kValues>
struct ConfigurationSet {
    const char* name{nullptr};
    std::array<AssignmentRow, kAssignments> assignments{};
    std::array<Scalar, kValues> values{};
};

/// Assigns `value` to `parameter` when the set becomes active. @param[in] parameter must outlive the table.
template <typename T, std::size_t kRanges>
constexpr auto assign(Parameter<T, kRanges>& parameter,
                      const typename Parameter<T, kRanges>::Value& value) noexcept {
    using Elements = detail::Elements<T>;
    Assignment<Elements::kCount> assignment{&parameter, {}};
    for (std::size_t i = 0U; i < Elements::kCount; ++i) {
        assignment.values[i] = to_scalar(Elements::get(value, i));
    }
    return assignment;
}

/// A set of values that become active together. @param[in] name static storage; unique in its table.
template <std::size_t... kElements>
constexpr auto configuration_set(const char* name, const Assignment<kElements>&... assignments) noexcept {
    ConfigurationSet<sizeof...(kElements), (kElements + ... + 0U)> set{};
    set.name = name;
    std::size_t next = 0U;
    std::size_t next_value = 0U;
    const auto add = [&](const auto& assignment) noexcept {
        AssignmentRow& row = set.assignments[next++];
        row.parameter = assignment.parameter;
        row.first_value = next_value;
        row.value_count = assignment.values.size();
        for (const Scalar& value : assignment.values) {
            set.values[next_value++] = value;
        }
    };
    (add(assignments), ...);
    static_cast<void>(add);
    return set;
}

/// Collects parameters and sets into a table, in any order, in a constant expression. Adding more than the
/// declared number is a compile error.
///
/// Thread safety: none. Time: add() is O(rows), finish() is O(parameters * assignments).
/// Memory:        the table and one declaration per parameter.
template <std::size_t kParameters, std::size_t kSets, std::size_t kAssignments, std::size_t kValues>
class ConfigurationBuilder final {
  public:
    /// Appends parameters, at most kParameters in total.
    template <typename Members>
    constexpr void add(const ParameterList<Members>& list) noexcept {
        for (const ParameterDeclaration& declaration : list.declarations) {
            declarations_[parameter_count_] = declaration;
            table_.parameters[parameter_count_] = declaration.row;
            ++parameter_count_;
        }
    }
    /// Appends a set, in total at most kSets sets with kAssignments assignments and kValues values.
    template <std::size_t kSetAssignments, std::size_t kSetValues>
    constexpr void add(const ConfigurationSet<kSetAssignments, kSetValues>& set) noexcept {
        table_.sets[set_count_] = {set.name, assignment_count_, kSetAssignments};
        ++set_count_;
        for (const AssignmentRow& assignment : set.assignments) {
            AssignmentRow& row = table_.assignments[assignment_count_];
            row = assignment;
            row.first_value += value_count_;
            ++assignment_count_;
        }
        for (const Scalar& value : set.values) {
            table_.values[value_count_] = value;
            ++value_count_;
        }
    }
    /// Completes the table after all parts were added. Checks each assignment against the declared
    /// parameters.
    constexpr ConfigurationTable<kParameters, kSets, kAssignments, kValues> finish() noexcept {
        for (AssignmentRow& row : table_.assignments) {
            const Span<const Scalar> values{&table_.values[row.first_value], row.value_count};
            for (const ParameterDeclaration& declaration : declarations_) {
                if (declaration.row.parameter == row.parameter) {
                    row.is_known = true;
                    row.is_refused = !declaration.admits(values);
                }
            }
        }
        return table_;
    }

  private:
    std::array<ParameterDeclaration, kParameters> declarations_{};
    ConfigurationTable<kParameters, kSets, kAssignments, kValues> table_{};
    std::size_t parameter_count_{0U};
    std::size_t set_count_{0U};
    std::size_t assignment_count_{0U};
    std::size_t value_count_{0U};
};

/// A table with the types of its parameters, so that compiler messages can name them.
template <typename MemberTypes, typename Table>
struct DescribedConfiguration : Table {
    using Members = MemberTypes;
};

/// Builds the table of these sets over the parameters of `list`. check() reports the rules that it violates.
template <typename Members, std::size_t... kAssignments, std::size_t... kValues>
constexpr auto configuration(const ParameterList<Members>& list,
                             const ConfigurationSet<kAssignments, kValues>&... sets) noexcept {
    ConfigurationBuilder<Members::kSize, sizeof...(kAssignments), (kAssignments + ... + 0U),
                         (kValues + ... + 0U)>
        builder{};
    builder.add(list);
    (builder.add(sets), ...);
    return DescribedConfiguration<Members, decltype(builder.finish())>{builder.finish()};
}

}  // namespace mamori

#endif  // MAMORI_KERNEL_CONFIGURATION_SET_HPP
