#pragma once

#include <cstdint>

#include "kinequad/extract/integer_points.h"

namespace kinequad::extraction {

/// Walks one cell from a port along its integer line and returns the port that it arrives at, that
/// of the next integer point which looks back. All decisions are exact. Throws `VerificationError`
/// where the line leaves the surface or takes more than `step_limit` steps.
int trace_port(const GridMap& map, const IntegerPoints& points, int port, std::int64_t step_limit);

}  // namespace kinequad::extraction
