// SPDX-License-Identifier: Apache-2.0
#include "mamori/ports/posix_rt/mapped_file.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <limits>

namespace mamori::ports::posix_rt {
namespace {

constexpr mode_t kMode = S_IRUSR | S_IWUSR | S_IRGRP | S_IROTH;
/// Non-blocking, so that a pipe or device is rejected without a wait.
constexpr int kFlags = O_RDWR | O_CLOEXEC | O_NONBLOCK;

}  // namespace

const char* describe(MappedFileError error) noexcept {
    switch (error) {
        case MappedFileError::kNone:
            return "mapped";
        case MappedFileError::kCannotOpen:
            return "cannot be opened for writing: check the path, the folder and its permissions";
        case MappedFileError::kNotRegular:
            return "is not a regular file: specify another path";
        case MappedFileError::kInUse:
            return "is in use by another program: end that program or specify another file";
        case MappedFileError::kWrongSize:
            return "has another size: move it away or specify another file";
        case MappedFileError::kCannotReserve:
            return "cannot be allocated: the device is full, or the file is too large for it";
        case MappedFileError::kCannotMap:
            return "cannot be mapped into memory";
    }
    return "failed for an unknown reason";  // reached with a corrupted value only
}

Status MappedFile::open(const char* path, std::size_t size) noexcept {
    if (is_open()) {
        return Status::kPreconditionNotMet;
    }
    if (path == nullptr || size == 0U || size > static_cast<std::size_t>(std::numeric_limits<off_t>::max())) {
        return Status::kBadParameter;
    }
    system_error_ = 0;
    error_ = map(path, size);
    switch (error_) {
        case MappedFileError::kNone:
            return Status::kOk;
        case MappedFileError::kCannotReserve:
        case MappedFileError::kCannotMap:
            return Status::kOutOfResources;
        case MappedFileError::kCannotOpen:
        case MappedFileError::kNotRegular:
        case MappedFileError::kInUse:
        case MappedFileError::kWrongSize:
            break;
    }
    return Status::kError;
}

/// Opens or creates the file. Removes a created file that could not be used.
MappedFileError MappedFile::map(const char* path, std::size_t size) noexcept {
    int file = ::open(path, kFlags | O_CREAT | O_EXCL, kMode);
    const bool is_new = file >= 0;
    if (!is_new && errno == EEXIST) {
        file = ::open(path, kFlags);
    }
    if (file < 0) {
        system_error_ = errno;
        const bool is_other_kind = errno == EISDIR || errno == ENXIO || errno == ENODEV;
        return is_other_kind ? MappedFileError::kNotRegular : MappedFileError::kCannotOpen;
    }
    const MappedFileError error = take(file, size);
    if (error == MappedFileError::kNone) {
        file_ = file;
        return error;
    }
    // A program that locked the new file before this process uses it, so it must not be removed.
    if (is_new && error != MappedFileError::kInUse) {
        static_cast<void>(::unlink(path));
    }
    static_cast<void>(::close(file));
    return error;
}

/// Locks, sizes and maps an open file.
MappedFileError MappedFile::take(int file, std::size_t size) noexcept {
    struct stat facts{};
    if (::fstat(file, &facts) != 0) {
        system_error_ = errno;
        return MappedFileError::kCannotOpen;
    }
    if (!S_ISREG(facts.st_mode)) {
        return MappedFileError::kNotRegular;
    }
    if (::flock(file, LOCK_EX | LOCK_NB) != 0) {
        system_error_ = errno;
        return errno == EWOULDBLOCK ? MappedFileError::kInUse : MappedFileError::kCannotOpen;
    }
    // Reads the size again: another process could have changed it before the lock.
    if (::fstat(file, &facts) != 0 || (facts.st_size != 0 && facts.st_size != static_cast<off_t>(size))) {
        return MappedFileError::kWrongSize;
    }
    const int refusal = ::posix_fallocate(file, 0, static_cast<off_t>(size));
    if (refusal != 0) {
        system_error_ = refusal;
        if (facts.st_size == 0) {
            static_cast<void>(::ftruncate(file, 0));
        }
        return MappedFileError::kCannotReserve;
    }
    void* const memory = ::mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_POPULATE, file, 0);
    if (memory == MAP_FAILED) {
        system_error_ = errno;
        return MappedFileError::kCannotMap;
    }
    data_ = static_cast<std::byte*>(memory);
    size_ = size;
    return MappedFileError::kNone;
}

void MappedFile::close() noexcept {
    if (!is_open()) {
        return;
    }
    static_cast<void>(::munmap(data_, size_));
    static_cast<void>(::close(file_));
    data_ = nullptr;
    size_ = 0U;
    file_ = -1;
}

Status MappedFile::flush() noexcept {
    if (!is_open()) {
        return Status::kPreconditionNotMet;
    }
    return ::msync(data_, size_, MS_SYNC) == 0 ? Status::kOk : Status::kError;
}

}  // namespace mamori::ports::posix_rt
