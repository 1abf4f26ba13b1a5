#include "kinequad/core/error.h"

namespace kinequad {
namespace {

ExitCode code_of(InputFault fault) {
    switch (fault) {
        case InputFault::usage:
            return ExitCode::usage;
        case InputFault::file:
            return ExitCode::file;
        case InputFault::mesh:
            return ExitCode::invalid_mesh;
        case InputFault::symmetry:
            return ExitCode::no_symmetry;
    }
    return ExitCode::internal_failure;
}

}  // namespace

InputError::InputError(InputFault fault, const std::string& message)
    : Error(code_of(fault), message), fault_(fault) {}

}  // namespace kinequad
