#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "kinequad/core/error.h"
#include "kinequad/io/landmarks.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace kinequad;
    try {
        const Landmarks landmarks =
            parse_landmarks({reinterpret_cast<const char*>(data), size}, "fuzz.json");
        for (const int vertex : landmarks.stationary) {
            if (vertex < 0) std::abort();
        }
    } catch (const InputError&) {
    }
    return 0;
}
