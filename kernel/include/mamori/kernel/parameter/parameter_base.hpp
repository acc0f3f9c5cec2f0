// SPDX-License-Identifier: Apache-2.0
/// @file
/// Type-independent interface of a parameter, for tables and tools that handle parameters of many types.
///
/// @satisfies SWR-PAR-003, SWR-PAR-005, SWR-PAR-011, SWR-PAR-020      Design:
/// docs/design/parameters.md#parameters
#ifndef MAMORI_KERNEL_PARAMETER_BASE_HPP
#define MAMORI_KERNEL_PARAMETER_BASE_HPP

#include <cstddef>
#include <cstdint>

#include "mamori/kernel/base/span.hpp"
#include "mamori/kernel/base/status.hpp"
#include "mamori/kernel/component/member.hpp"
#include "mamori/kernel/parameter/scalar.hpp"

namespace mamori {

/// One range of a constraint, untyped. An element can have each value that is in one of its ranges.
struct ScalarRange {
    Scalar lower{};
    Scalar upper{};
    std::uint16_t element{0U};  ///< index of the element, or Range<S>::kEachElement
    bool has_lower{false};      ///< false: the range starts at the minimum of the type
    bool has_upper{false};      ///< false: the range ends at the maximum of the type
    bool is_lower_open{false};
    bool is_upper_open{false};
};

/// Type-independent part of a parameter, for the configuration admin and for tools.
///
/// Thread safety: check(), requests and properties fixed at construction from any thread, wait-free; the
///                other members only from the context that runs the component, between its cycles.
/// Time:          O(elements * ranges of the constraint). Memory: no heap.
class ParameterBase : public Member {
  public:
    /// Number of elements: 1 for a scalar, else the size of the array.
    std::size_t get_element_count() const noexcept { return element_count_; }
    /// False if the constraint is invalid or the default value violates it. Such a parameter keeps its
    /// default value and admits no value; it cannot be a compile-time constant.
    bool is_valid() const noexcept { return get_range(0U).has_value(); }

    /// Checks whether the parameter can have these values.
    /// @param[in] values one per element.
    /// @return kOk; kBadParameter (wrong number of values, a value that the type cannot represent, or a value
    ///         that violates the constraint).
    virtual Status check(Span<const Scalar> values) const noexcept = 0;
    /// Requests `values` for the next commit(). Only the last request before it takes effect.
    /// @return kOk; kBadParameter (as check()); kPreconditionNotMet (another request or the commit is
    ///         accessing this parameter at this moment: retry).
    virtual Status request_scalars(Span<const Scalar> values) noexcept = 0;
    /// Range `index` of the constraint, in the order of declaration.
    /// @return the range; kBadParameter (no such range; an invalid parameter has none).
    virtual Result<ScalarRange> get_range(std::size_t index) const noexcept = 0;
    /// Copies the active value. @param[out] values one per element; written only if kOk is returned.
    /// @return kOk; kBadParameter (values.size() is not the number of elements).
    virtual Status read(Span<Scalar> values) const noexcept = 0;

    /// @name For the configuration admin, between cycles
    /// @{
    /// Makes these values active. @return as check().
    virtual Status activate(Span<const Scalar> values) noexcept = 0;
    /// Makes the requested value active. @return true if there was one, and no request was in progress.
    virtual bool commit() noexcept = 0;
    /// @}

  protected:
    /// @param[in] owner component or kNoOwner. @param[in] element_count >= 1.
    template <typename Owner>
    constexpr ParameterBase(Owner& owner, const char* name, std::size_t element_count) noexcept
        : Member(owner, MemberKind::kParameter, name), element_count_(element_count) {}
    ~ParameterBase() = default;

  private:
    std::size_t element_count_;
};

}  // namespace mamori

#endif  // MAMORI_KERNEL_PARAMETER_BASE_HPP
