// SPDX-License-Identifier: Apache-2.0
/// @file
/// A parameter of a component: a value with a constraint. It is set from outside the component and never
/// changes during a cycle of the component. It is a member of the component, constructed and listed like a
/// port:
///
///     mamori::Parameter<double> limit_rad_s{*this, "limit_rad_s", 1.0, mamori::between(0.1, 3.0)};
///     using Parameters = mamori::Parameters<&SpeedMonitor::limit_rad_s>;
///
/// @satisfies SWR-PAR-003, SWR-PAR-004, SWR-PAR-005, SWR-PAR-011, SWR-PAR-020
/// Design:   docs/design/parameters.md#parameters
#ifndef MAMORI_KERNEL_PARAMETER_HPP
#define MAMORI_KERNEL_PARAMETER_HPP

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "mamori/kernel/base/assert.hpp"
#include "mamori/kernel/base/span.hpp"
#include "mamori/kernel/base/status.hpp"
#include "mamori/kernel/component/member.hpp"
#include "mamori/kernel/parameter/constraint.hpp"
#include "mamori/kernel/parameter/detail/parameter_elements.hpp"
#include "mamori/kernel/parameter/parameter_base.hpp"
#include "mamori/kernel/parameter/scalar.hpp"

namespace mamori {
namespace detail {

/// In a constant expression, a violation stops the compiler, and the message shows the function name. At run
/// time it has no effect: the parameter is then invalid.
constexpr void require_default_within_constraint(bool is_admitted) noexcept {
    MAMORI_REQUIRE(1, is_admitted || !__builtin_is_constant_evaluated());
}

/// Access state of the requested value. Access is acquired with one atomic exchange, so no thread waits.
enum class RequestSlot : std::uint8_t { kEmpty, kFull, kBusy };

}  // namespace detail

/// Parameter of type T: bool, an integer, float, double, an enum, or a `std::array` of one of them.
///
/// If the component is a constant (MAMORI_CONSTINIT), the compiler rejects a limit that the type cannot
/// represent, a range without a value, and a default value that violates the constraint. Otherwise such a
/// parameter is invalid: it admits no value, and initialize() of the executive rejects the table.
///
/// Thread safety: as ParameterBase; get() from its component, admits() from any thread.
/// Time:          O(elements * kRanges); get() and commit() copy at most one T. Nothing blocks.
/// Memory:        two T and kRanges ranges with two limits each, no heap.
/// @tparam kRanges capacity for the ranges and choices of the constraint over all elements, 1 .. 65534.
template <typename T, std::size_t kRanges = detail::Elements<T>::kCount + 3U>
class Parameter final : public ParameterBase {
    using Elements = detail::Elements<T>;
    using Element = typename Elements::Element;
    static_assert(is_scalar<Element>(),
                  "a parameter is a bool, integer, float, double, enum or an array of one of them");
    static_assert(Elements::kCount > 0U, "a parameter has at least one element");

  public:
    using Value = T;

    /// @param[in] owner         the component that has this parameter as a member, `*this`; kNoOwner: none.
    /// @param[in] name          name within the component, static storage, not nullptr.
    /// @param[in] default_value initial value; must satisfy the constraint.
    /// @param[in] constraints   none, one for all elements, or one for each element; see constraint.hpp.
    template <typename Owner, typename... Cs>
    constexpr Parameter(Owner& owner, const char* name, const T& default_value,
                        const Cs&... constraints) noexcept
        : ParameterBase(owner, name, Elements::kCount),
          constraint_(make_constraint<Element, kRanges, Elements::kCount>(constraints...)),
          active_(default_value),
          requested_(default_value) {
        static_assert(std::is_base_of_v<MemberOwner, Owner> || std::is_same_v<const Owner, const NoOwner>,
                      "a parameter is constructed with its component, {*this, ...}, or with kNoOwner");
        const bool is_admitted = admits(default_value);
        detail::require_default_within_constraint(is_admitted);
        if (!is_admitted) {
            constraint_.clear();
        }
    }

    /// The active value; constant during a cycle. The reference is valid as long as the parameter.
    constexpr const T& get() const noexcept { return active_; }

    /// Whether `value` satisfies the constraint.
    constexpr bool admits(const T& value) const noexcept {
        for (std::size_t i = 0U; i < Elements::kCount; ++i) {
            if (!constraint_.admits(Elements::get(value, i), i)) {
                return false;
            }
        }
        return true;
    }
    /// The same for untyped values, one per element; false also for a wrong number or type of values.
    constexpr bool admits_scalars(Span<const Scalar> values) const noexcept {
        const Result<T> value = to_value(values);
        return value.has_value() && admits(value.get_value());
    }

    /// Requests that `value` becomes active at the next commit(); from any thread. @return as
    /// request_scalars().
    Status request(const T& value) noexcept {
        if (!admits(value)) {
            return Status::kBadParameter;
        }
        if (slot_.exchange(detail::RequestSlot::kBusy, std::memory_order_acq_rel) ==
            detail::RequestSlot::kBusy) {
            return Status::kPreconditionNotMet;
        }
        requested_ = value;
        slot_.store(detail::RequestSlot::kFull, std::memory_order_release);
        return Status::kOk;
    }

    Status check(Span<const Scalar> values) const noexcept override {
        return admits_scalars(values) ? Status::kOk : Status::kBadParameter;
    }
    Status request_scalars(Span<const Scalar> values) noexcept override {
        const Result<T> value = to_value(values);
        return value.has_value() ? request(value.get_value()) : value.get_status();
    }
    Result<ScalarRange> get_range(std::size_t index) const noexcept override {
        const Span<const Range<Element>> ranges = constraint_.get_ranges();
        if (index >= ranges.size()) {
            return Status::kBadParameter;
        }
        const Range<Element>& range = ranges[index];
        return ScalarRange{to_scalar(range.lower),
                           to_scalar(range.upper),
                           range.element,
                           range.is_lower_open || range.lower > Range<Element>::kLowest,
                           range.is_upper_open || range.upper < Range<Element>::kMax,
                           range.is_lower_open,
                           range.is_upper_open};
    }
    Status read(Span<Scalar> values) const noexcept override {
        if (values.size() != Elements::kCount) {
            return Status::kBadParameter;
        }
        for (std::size_t i = 0U; i < Elements::kCount; ++i) {
            values[i] = to_scalar(Elements::get(active_, i));
        }
        return Status::kOk;
    }
    Status activate(Span<const Scalar> values) noexcept override {
        const Result<T> value = to_value(values);
        if (!value.has_value() || !admits(value.get_value())) {
            return Status::kBadParameter;
        }
        active_ = value.get_value();
        return Status::kOk;
    }
    bool commit() noexcept override {
        // Only this function empties the slot, so a slot that is full here can only become busy.
        if (slot_.load(std::memory_order_relaxed) != detail::RequestSlot::kFull ||
            slot_.exchange(detail::RequestSlot::kBusy, std::memory_order_acq_rel) ==
                detail::RequestSlot::kBusy) {
            return false;
        }
        active_ = requested_;
        slot_.store(detail::RequestSlot::kEmpty, std::memory_order_release);
        return true;
    }

  private:
    static constexpr Result<T> to_value(Span<const Scalar> values) noexcept {
        if (values.size() != Elements::kCount) {
            return Status::kBadParameter;
        }
        T value{};
        for (std::size_t i = 0U; i < Elements::kCount; ++i) {
            const Result<Element> element = from_scalar<Element>(values[i]);
            if (!element.has_value()) {
                return element.get_status();
            }
            Elements::set(value, i, element.get_value());
        }
        return value;
    }

    Constraint<Element, kRanges> constraint_;
    T active_;
    T requested_;
    std::atomic<detail::RequestSlot> slot_{detail::RequestSlot::kEmpty};
};

/// Parameters of a component, as pointers to its members. A component without this alias has no parameters.
template <auto... kMembers>
struct Parameters {
    static constexpr std::size_t kCount = sizeof...(kMembers);
};

}  // namespace mamori

#endif  // MAMORI_KERNEL_PARAMETER_HPP
