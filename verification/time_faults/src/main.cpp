// SPDX-License-Identifier: Apache-2.0
// time_faults FRAMES FAULTS SEED [storm]: prints the verdict as JSON; status 1 when a fault was not seen as
// it should be, or something was that is none.
#include <charconv>
#include <cstring>
#include <iostream>

#include "time_faults.hpp"

namespace {

bool read(const char* text, std::uint64_t& number) {
    const char* const end = text + std::strlen(text);
    const std::from_chars_result result = std::from_chars(text, end, number);
    return result.ec == std::errc{} && result.ptr == end;
}

}  // namespace

int main(int argc, char** argv) {
    mamori::time_faults::Request request;
    std::uint64_t faults = 0U;
    request.with_storm = argc == 5 && std::strcmp(argv[4], "storm") == 0;
    if ((argc != 4 && !request.with_storm) || !read(argv[1], request.frame_count) || !read(argv[2], faults) ||
        !read(argv[3], request.seed) || request.frame_count == 0U ||
        faults > request.frame_count / mamori::time_faults::kDistance) {
        std::cerr << "time_faults: expected FRAMES FAULTS SEED and perhaps 'storm': whole numbers, at least "
                     "1 frame and "
                  << mamori::time_faults::kDistance << " frames for each fault\n";
        return 2;
    }
    request.injection_count = faults;
    const mamori::time_faults::Verdict verdict = mamori::time_faults::run(request);
    std::cout << mamori::time_faults::to_json(request, verdict);
    return verdict.is_well() ? 0 : 1;
}
