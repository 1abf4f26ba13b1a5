#include "fuzz_mesh.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    return kinequad::fuzz::read_as_mesh(data, size, "fuzz.obj");
}
