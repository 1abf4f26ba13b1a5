#include "support/data.h"

#include <cstdlib>

namespace kinequad::test {

std::filesystem::path data_folder() {
    const char* set = std::getenv("KINEQUAD_DATA");
    const std::filesystem::path folder = set != nullptr ? set : KINEQUAD_DATA;
    return std::filesystem::is_directory(folder) ? std::filesystem::canonical(folder)
                                                 : std::filesystem::path{};
}

}  // namespace kinequad::test
