// SPDX-License-Identifier: Apache-2.0
/// @file
/// Return codes of all operations that can fail, and a result type that holds a value or a return code. The
/// six codes and their numbers are those of the OMG RTC ReturnCode_t; there are no other codes.
///
/// @satisfies SWR-KRN-001      Design: docs/design/kernel.md#errors
/// Source:   OMG RTC 1.0, ReturnCode_t (IDL order is the wire value)
#ifndef MAMORI_KERNEL_STATUS_HPP
#define MAMORI_KERNEL_STATUS_HPP

#include <cstdint>
#include <type_traits>

namespace mamori {

/// Outcome of an operation. On any code except kOk, the called object is unchanged unless the operation
/// specifies otherwise.
enum class [[nodiscard]] Status : std::uint32_t {
    kOk = 0U,                  ///< done
    kError = 1U,               ///< failed for a reason that no other code describes
    kBadParameter = 2U,        ///< an argument is outside its range
    kUnsupported = 3U,         ///< the operation is not implemented for this object
    kOutOfResources = 4U,      ///< a bounded capacity is exhausted
    kPreconditionNotMet = 5U,  ///< the state of the object does not allow the operation
};

/// Name of a status in the RTC standard, for logs and reports; never nullptr.
constexpr const char* get_name(Status status) noexcept {
    switch (status) {
        case Status::kOk:
            return "RTC_OK";
        case Status::kError:
            return "RTC_ERROR";
        case Status::kBadParameter:
            return "BAD_PARAMETER";
        case Status::kUnsupported:
            return "UNSUPPORTED";
        case Status::kOutOfResources:
            return "OUT_OF_RESOURCES";
        case Status::kPreconditionNotMet:
            return "PRECONDITION_NOT_MET";
    }
    return "INVALID_STATUS";  // only a corrupted value gets here
}

/// A value, or the status that explains why the value is missing.
///
/// Thread safety: none. Time: O(1). Memory: holds one T, which must be default constructible.
template <typename T>
class [[nodiscard]] Result final {
    static_assert(std::is_default_constructible_v<T>, "Result<T> keeps a T even when it holds a status");

  public:
    constexpr Result(const T& value) noexcept
        : value_(value), status_(Status::kOk) {}  // NOLINT: implicit on purpose
    /// @param[in] status the reason; kOk becomes kError, because a success requires a value.
    constexpr Result(Status status) noexcept  // NOLINT: implicit on purpose
        : value_(), status_(status == Status::kOk ? Status::kError : status) {}

    constexpr bool has_value() const noexcept { return status_ == Status::kOk; }
    /// kOk when a value is present; otherwise the reason why it is missing.
    constexpr Status get_status() const noexcept { return status_; }
    /// @return the value; a default-constructed T when has_value() is false.
    constexpr const T& get_value() const noexcept { return value_; }

  private:
    T value_;
    Status status_;
};

}  // namespace mamori

#endif  // MAMORI_KERNEL_STATUS_HPP
