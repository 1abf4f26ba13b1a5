#pragma once

namespace kinequad {

/// Version of the library and the program.
extern const char* const version;

}  // namespace kinequad
