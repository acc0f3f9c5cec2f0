// SPDX-License-Identifier: Apache-2.0
/// @file
/// A file of fixed size in the memory of the process: what is stored there outlives the process, however it
/// ends.
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
    kCannotOpen,     ///< no such folder, no permission, read-only folder or file
    kNotRegular,     ///< a folder, a device or a pipe
    kInUse,          ///< another MappedFile, here or in another process, has it
    kWrongSize,      ///< the file has another size, and is left as it is
    kCannotReserve,  ///< no space on the device, or a larger file than the limits allow
    kCannotMap,      ///< the system refuses the mapping
};

/// A sentence for the user; never nullptr.
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

    /// Maps the file at `path`. One that is not there, or is empty, gets its size, filled with zeros.
    /// @param[in] path not nullptr. @param[in] size of the file [byte], from 1 on.
    /// @return kOk; kBadParameter (path or size); kPreconditionNotMet (open already); kOutOfResources
    /// (kCannotReserve,
    ///         kCannotMap); kError (every other cause): get_error() and get_system_error() tell it, and no
    ///         file is left that was not there.
    Status open(const char* path, std::size_t size) noexcept;
    /// Ends mapping and lock; without an open file it does nothing.
    void close() noexcept;

    bool is_open() const noexcept { return data_ != nullptr; }
    /// The bytes of the file; empty while closed. Valid until close().
    Span<std::byte> get_region() const noexcept { return {data_, size_}; }

    /// Waits until the device holds what was stored, for the sake of a loss of power; a crash does not need
    /// it.
    /// @return kOk; kPreconditionNotMet (closed); kError (the device failed).
    Status flush() noexcept;

    /// Cause of the last open() that failed; kNone before it, and after one that did not.
    MappedFileError get_error() const noexcept { return error_; }
    /// `errno` behind it; 0 where the system had no objection.
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
