// SPDX-License-Identifier: Apache-2.0
/// @file
/// A memory-mapped file of fixed size. Stored data is retained after the end of the process, also after a
/// crash.
///
/// @satisfies SWR-REC-010      Design: docs/design/recorder.md#mapped-file
#ifndef MAMORI_PORTS_POSIX_RT_MAPPED_FILE_HPP
#define MAMORI_PORTS_POSIX_RT_MAPPED_FILE_HPP

#include <cstddef>
#include <cstdint>

#include "mamori/kernel/base/span.hpp"
#include "mamori/kernel/base/status.hpp"

namespace mamori::ports::posix_rt {

/// Why a file was not mapped.
enum class MappedFileError : std::uint8_t {
    kNone,
    kCannotOpen,     ///< folder does not exist, permission missing, or folder or file is read-only
    kNotRegular,     ///< path is a folder, a device or a pipe
    kInUse,          ///< another MappedFile of this or another process uses the file
    kWrongSize,      ///< the file has another size; it is not changed
    kCannotReserve,  ///< no space on the device, or the file exceeds the limits
    kCannotMap,      ///< the system rejects the mapping
};

/// Message for the user; never nullptr.
const char* describe(MappedFileError error) noexcept;

/// Owner of one mapping and of the lock on its file; both end with it.
///
/// Thread safety: none. Time: the calls wait for the file system; call them before the first deadline begins.
/// Memory: the mapping, `size` bytes rounded up to pages.
class MappedFile final {
  public:
    MappedFile() noexcept = default;
    ~MappedFile() { close(); }
    MappedFile(const MappedFile&) = delete;
    MappedFile& operator=(const MappedFile&) = delete;

    /// Maps the file at `path`. A missing or empty file is created with `size` zero bytes.
    /// @param[in] path not nullptr. @param[in] size size of the file [byte], from 1.
    /// @return kOk; kBadParameter (path or size); kPreconditionNotMet (open already); kOutOfResources
    /// (kCannotReserve,
    ///         kCannotMap); kError (every other cause). get_error() and get_system_error() return the cause.
    ///         On failure, no new file remains.
    Status open(const char* path, std::size_t size) noexcept;
    /// Ends mapping and lock. Without an open file, the call has no effect.
    void close() noexcept;

    bool is_open() const noexcept { return data_ != nullptr; }
    /// The bytes of the file; empty while closed. Valid until close().
    Span<std::byte> get_region() const noexcept { return {data_, size_}; }

    /// Waits until the device has stored the data. Protects against a power loss; not necessary for a crash.
    /// @return kOk; kPreconditionNotMet (closed); kError (the device failed).
    Status flush() noexcept;

    /// Cause of the failure of the last open(); kNone if it succeeded or was not called.
    MappedFileError get_error() const noexcept { return error_; }
    /// `errno` of this failure; 0 if no system call failed.
    int get_system_error() const noexcept { return system_error_; }

  private:
    MappedFileError map(const char* path, std::size_t size) noexcept;
    MappedFileError take(int file, std::size_t size) noexcept;

    std::byte* data_{nullptr};
    std::size_t size_{0U};
    int file_{-1};
    int system_error_{0};
    MappedFileError error_{MappedFileError::kNone};
};

}  // namespace mamori::ports::posix_rt

#endif  // MAMORI_PORTS_POSIX_RT_MAPPED_FILE_HPP
