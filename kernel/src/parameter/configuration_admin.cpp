// SPDX-License-Identifier: Apache-2.0
#include "mamori/kernel/parameter/configuration_admin.hpp"

#include "mamori/kernel/base/assert.hpp"

namespace mamori {
namespace {

/// Stores findings up to the capacity and counts all of them.
struct FindingList {
    Span<ConfigurationFinding> findings;
    std::size_t count{0U};

    void operator()(const ConfigurationFinding& finding) noexcept {
        if (count < findings.size()) {
            findings[count] = finding;
        }
        ++count;
    }
};

}  // namespace

std::size_t collect_findings(const ConfigurationView& view, Span<ConfigurationFinding> findings) noexcept {
    FindingList list{findings};
    detail::visit_invalid_rows(view, list);
    if (list.count != 0U) {
        return list.count;
    }
    detail::visit_findings(view, list);
    for (std::size_t s = 0U; s < view.sets.size(); ++s) {
        const Span<const AssignmentRow> rows = view.get_assignments(view.sets[s]);
        for (std::size_t a = 0U; a < rows.size(); ++a) {
            if (!rows[a].is_refused && rows[a].parameter->check(view.get_values(rows[a])) != Status::kOk) {
                list({ConfigurationRule::kValueOutsideConstraint, s, a});
            }
        }
    }
    return list.count;
}

Status ConfigurationAdmin::activate_configuration_set(std::size_t index) noexcept {
    if (index >= view_.sets.size()) {
        return Status::kBadParameter;
    }
    requested_.store(static_cast<std::uint32_t>(index), std::memory_order_release);
    return Status::kOk;
}

Status ConfigurationAdmin::activate_configuration_set(Text name) noexcept {
    for (std::size_t i = 0U; i < view_.sets.size(); ++i) {
        if (make_text(view_.sets[i].name) == name) {
            return activate_configuration_set(i);
        }
    }
    return Status::kBadParameter;
}

bool ConfigurationAdmin::is_known(const ParameterBase& parameter) const noexcept {
    for (const ParameterRow& row : view_.parameters) {
        if (row.parameter == &parameter) {
            return true;
        }
    }
    return false;
}

Status ConfigurationAdmin::set_value(ParameterBase& parameter, Span<const Scalar> values) noexcept {
    return is_known(parameter) ? parameter.request_scalars(values) : Status::kBadParameter;
}

Result<ParameterBase*> ConfigurationAdmin::find(Text component, Text parameter) const noexcept {
    for (const ParameterRow& row : view_.parameters) {
        if (make_text(row.owner->get_name()) == component &&
            make_text(row.parameter->get_name()) == parameter) {
            return row.parameter;
        }
    }
    return Status::kBadParameter;
}

std::size_t ConfigurationAdmin::take_requested_set() noexcept {
    return requested_.exchange(kNone, std::memory_order_acq_rel);
}

ConfigurationFinding ConfigurationAdmin::judge_set(std::size_t set) const noexcept {
    const Span<const AssignmentRow> rows = view_.get_assignments(view_.sets[set]);
    for (std::size_t a = 0U; a < rows.size(); ++a) {
        if (rows[a].parameter->check(view_.get_values(rows[a])) != Status::kOk) {
            return {ConfigurationRule::kValueOutsideConstraint, set, a};
        }
    }
    return {};
}

void ConfigurationAdmin::activate_set(std::size_t set, Span<const ParameterRow> parameters) noexcept {
    for (const AssignmentRow& row : view_.get_assignments(view_.sets[set])) {
        for (const ParameterRow& own : parameters) {
            if (own.parameter == row.parameter) {
                const Status result = row.parameter->activate(view_.get_values(row));
                MAMORI_ENSURE(2, result == Status::kOk);
            }
        }
    }
    active_.store(static_cast<std::uint32_t>(set), std::memory_order_release);
}

void ConfigurationAdmin::commit(Span<const ParameterRow> parameters) noexcept {
    for (const ParameterRow& row : parameters) {
        static_cast<void>(row.parameter->commit());
    }
}

Status ConfigurationAdmin::switch_at_frame_boundary() noexcept {
    const std::size_t set = take_requested_set();
    Status result = Status::kOk;
    if (set != kNoConfigurationSet) {
        const ConfigurationFinding finding = judge_set(set);
        if (finding.rule == ConfigurationRule::kNone) {
            activate_set(set, view_.parameters);
        } else {
            last_finding_ = finding;
            result = Status::kBadParameter;
        }
    }
    commit(view_.parameters);
    return result;
}

}  // namespace mamori
