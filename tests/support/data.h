#pragma once

#include <gtest/gtest.h>

#include <filesystem>

namespace kinequad::test {

/// Folder of the real sequences: the environment variable KINEQUAD_DATA, else the folder that the
/// build was configured with. Empty where it is absent.
std::filesystem::path data_folder();

}  // namespace kinequad::test

/// Skips the running test, saying why, where the real sequences are absent.
#define KINEQUAD_REQUIRE_DATA()                                                               \
    if (::kinequad::test::data_folder().empty()) {                                            \
        GTEST_SKIP() << "the real sequences are not here; set KINEQUAD_DATA to their folder"; \
    }                                                                                         \
    static_cast<void>(0)
