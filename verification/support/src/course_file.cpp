// SPDX-License-Identifier: Apache-2.0
#include "mamori/verification/course_file.hpp"

#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstring>

namespace mamori::verification {

CourseFile::CourseFile(const char* subject) : text_("{\"schema\": \"mamori.fault_course/1\"") {
    add("subject", subject);
}

void CourseFile::add(const char* key, std::initializer_list<const char*> names) {
    std::string list;
    for (const char* const name : names) {
        list += (list.empty() ? "\"" : ", \"") + std::string{name} + '"';
    }
    add_text(key, '[' + list + ']');
}

void CourseFile::add(const char* key, const HostFigures& host) {
    const auto field = [](const char* name, std::int64_t value) {
        return '"' + std::string{name} + "\": " + std::to_string(value);
    };
    const auto count = [&field](const char* name, std::uint64_t value) {
        return field(name, static_cast<std::int64_t>(value));
    };
    add_text(key, '{' + count("stalls", host.stalls) + ", " +
                      field("longest_stall_ns", host.longest_stall.ns) + ", " +
                      field("lost_ns", host.lost.ns) + ", " + count("late_polls", host.late_polls) + ", " +
                      field("run_delay_ns", host.run_delay.ns) + ", " + count("steal_ms", host.steal_ms) +
                      ", " + count("involuntary_switches", host.involuntary_switches) + '}');
}

void CourseFile::add(const char* key, const std::vector<Stall>& spans) {
    add<Stall>(key, spans,
               {{"begin_ns", [](const Stall& span) { return span.begin.ns; }},
                {"end_ns", [](const Stall& span) { return span.end.ns; }}});
}

void CourseFile::add_text(const char* key, const std::string& value) {
    text_ += ",\n\"" + std::string{key} + "\": " + value;
}

void CourseFile::begin_column(const char* name) {
    text_ += (text_.back() == '{' ? "\n \"" : ",\n \"") + std::string{name} + "\": [";
}

void CourseFile::add_difference(std::int64_t value) {
    if (text_.back() != '[') {
        text_ += ',';
    }
    text_ += std::to_string(value);
}

bool CourseFile::write(const char* path) const {
    const std::string part = std::string{path} + ".part";
    std::FILE* const file = std::fopen(part.c_str(), "wb");
    bool is_written = file != nullptr && std::fwrite(text_.data(), 1U, text_.size(), file) == text_.size() &&
                      std::fputs("\n}\n", file) >= 0;
    is_written = (file == nullptr || std::fclose(file) == 0) && is_written;
    if (is_written && std::rename(part.c_str(), path) == 0) {
        return true;
    }
    const int error = errno;
    static_cast<void>(std::remove(part.c_str()));
    std::fprintf(stderr, "%s: cannot be written: %s; specify another file\n", path, std::strerror(error));
    return false;
}

const char* take_option(int& count, char** arguments, const char* name) noexcept {
    if (count < 3 || std::strcmp(arguments[count - 2], name) != 0) {
        return nullptr;
    }
    count -= 2;
    return arguments[count + 1];
}

bool read_number(const char* text, std::uint64_t& number) noexcept {
    const char* const end = text + std::strlen(text);
    const std::from_chars_result result = std::from_chars(text, end, number);
    return result.ec == std::errc{} && result.ptr == end;
}

}  // namespace mamori::verification
