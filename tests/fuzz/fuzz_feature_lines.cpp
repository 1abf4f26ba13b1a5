#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "kinequad/core/error.h"
#include "kinequad/io/feature_lines.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace kinequad;
    try {
        const FeatureLines lines =
            parse_feature_lines({reinterpret_cast<const char*>(data), size}, "fuzz.json");
        for (const auto& [from, to] : lines) {
            if (from < 0 || to < 0) std::abort();
        }
    } catch (const InputError&) {
    }
    return 0;
}
