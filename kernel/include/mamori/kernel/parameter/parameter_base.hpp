// SPDX-License-Identifier: Apache-2.0
/// @file
/// What every parameter can do, whatever its type: for tables and tools that hold parameters of many types.
///
/// @satisfies SWR-PAR-003, SWR-PAR-005, SWR-PAR-011      Design: docs/design/parameters.md#parameters
#ifndef MAMORI_KERNEL_PARAMETER_BASE_HPP
#define MAMORI_KERNEL_PARAMETER_BASE_HPP

#include <cstddef>
#include <cstdint>

#include "mamori/kernel/base/span.hpp"
#include "mamori/kernel/base/status.hpp"
#include "mamori/kernel/parameter/scalar.hpp"

namespace mamori {

/// One range of a constraint without its type. An element may have a value that lies in any of its ranges.
struct ScalarRange {
    Scalar lower{};
    Scalar upper{};
    std::uint16_t element{0U};  ///< or Range<S>::kEachElement
    bool has_lower{false};      ///< else the range begins with the minimum of the type
    bool has_upper{false};      ///< else the range ends with the maximum of the type
    bool is_lower_open{false};
    bool is_upper_open{false};
};

/// Type-free part of a parameter, for the configuration admin and for tools.
///
/// Thread safety: check(), the requests and what was given at construction from any thread, each without
///                waiting; the others only from the context that runs the component, between its cycles.
/// Time:          O(elements * ranges of the constraint). Memory: no heap.
class ParameterBase {
  public:
    ParameterBase(const ParameterBase&) = delete;
    ParameterBase& operator=(const ParameterBase&) = delete;

    /// Name within the component; static storage, never nullptr.
    const char* get_name() const noexcept { return name_; }
    /// 1 for a scalar, else the size of the array.
    std::size_t get_element_count() const noexcept { return element_count_; }
    /// False if the default violates the constraint, or the constraint is invalid. Such a parameter has its
    /// default and admits no value; only one that is not a constant of the program can be so.
    bool is_valid() const noexcept { return get_range(0U).has_value(); }

    /// May the parameter have these values?
    /// @param[in] values one per element.
    /// @return kOk; kBadParameter (their count, a value that the type does not have, or the constraint).
    virtual Status check(Span<const Scalar> values) const noexcept = 0;
    /// Asks for a value from the next commit() on. Of several requests before it the last one counts.
    /// @return kOk; kBadParameter as check(); kPreconditionNotMet (another request or the commit is at this
    ///         parameter at this moment: ask again).
    virtual Status request_scalars(Span<const Scalar> values) noexcept = 0;
    /// Range `index` of the constraint, in the order of the declaration.
    /// @return kBadParameter (there are not so many ranges; an invalid parameter has none).
    virtual Result<ScalarRange> get_range(std::size_t index) const noexcept = 0;
    /// Copies the active value. @param[out] values one per element; written on kOk only.
    /// @return kOk; kBadParameter (not one place per element).
    virtual Status read(Span<Scalar> values) const noexcept = 0;

    /// @name For the configuration admin, between cycles
    /// @{
    /// Makes these values the active ones. @return as check().
    virtual Status activate(Span<const Scalar> values) noexcept = 0;
    /// Makes the requested value the active one. @return true when there was one.
    virtual bool commit() noexcept = 0;
    /// @}

  protected:
    /// @param[in] name static storage, not nullptr. @param[in] element_count >= 1.
    constexpr ParameterBase(const char* name, std::size_t element_count) noexcept
        : name_(name), element_count_(element_count) {}
    ~ParameterBase() = default;

  private:
    const char* name_;
    std::size_t element_count_;
};

}  // namespace mamori

#endif  // MAMORI_KERNEL_PARAMETER_BASE_HPP
