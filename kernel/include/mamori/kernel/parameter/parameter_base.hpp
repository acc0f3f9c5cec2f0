// SPDX-License-Identifier: Apache-2.0
/// @file
/// What every parameter can do, whatever its type: for tables and tools that hold parameters of many types.
///
/// @satisfies SWR-PAR-003, SWR-PAR-005      Design: docs/design/parameters.md#parameters
#ifndef MAMORI_KERNEL_PARAMETER_BASE_HPP
#define MAMORI_KERNEL_PARAMETER_BASE_HPP

#include <cstddef>

#include "mamori/kernel/base/span.hpp"
#include "mamori/kernel/base/status.hpp"
#include "mamori/kernel/base/text_cursor.hpp"
#include "mamori/kernel/parameter/scalar.hpp"

namespace mamori {

/// Type-free part of a parameter, for the configuration admin and for tools.
///
/// Thread safety: check(), the requests and what was given at construction from any thread, each without
///                waiting; the others only from the context that runs the component, between its cycles.
/// Time:          O(elements * ranges of the constraint), for a text also its length. Memory: no heap.
class ParameterBase {
  public:
    ParameterBase(const ParameterBase&) = delete;
    ParameterBase& operator=(const ParameterBase&) = delete;

    /// Name within the component; static storage, never nullptr.
    const char* get_name() const noexcept { return name_; }
    /// Text of the constraint as it was declared; "" when there is none.
    const char* get_constraint() const noexcept { return constraint_text_; }
    /// 1 for a scalar, else the size of the array.
    std::size_t get_element_count() const noexcept { return element_count_; }

    /// May the parameter have these values?
    /// @param[in] values one per element.
    /// @return kOk; kBadParameter (their count, a value that the type does not have, or the constraint).
    virtual Status check(Span<const Scalar> values) const noexcept = 0;
    /// Asks for a value from the next commit() on. Of several requests before it the last one counts.
    /// @return kOk; kBadParameter as check(); kPreconditionNotMet (another request or the commit is at this
    ///         parameter at this moment: ask again).
    virtual Status request_scalars(Span<const Scalar> values) noexcept = 0;
    /// The same for a text: numbers or names, separated by commas, as configuration files have them.
    /// @param[in] text one word per element; need not outlive the call.
    /// @return as request_scalars(); kBadParameter also for a text that does not spell the values.
    virtual Status request_text(Text text) noexcept = 0;
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
    /// @param[in] name, constraint static storage, not nullptr. @param[in] element_count >= 1.
    constexpr ParameterBase(const char* name, const char* constraint, std::size_t element_count) noexcept
        : name_(name), constraint_text_(constraint), element_count_(element_count) {}
    ~ParameterBase() = default;

  private:
    const char* name_;
    const char* constraint_text_;
    std::size_t element_count_;
};

}  // namespace mamori

#endif  // MAMORI_KERNEL_PARAMETER_BASE_HPP
