#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "kinequad/io/memory_sequence.h"
#include "kinequad/pipeline/options.h"
#include "support/shapes.h"

namespace kinequad::test {

/// Frames of a torus, its own mirror image in many planes, that becomes longer along x by `stretch`
/// of its size from one to the next.
inline MemorySequence stretched_torus(int frame_count, double stretch, std::string name) {
    const TriangleMesh mesh = torus(48, 24);
    std::vector<Positions> frames;
    for (int j = 0; j < frame_count; ++j) {
        Positions V = mesh.V;
        V.col(0) *= 1 + stretch * j;
        frames.push_back(V);
    }
    return {mesh.F, frames, std::nullopt, std::move(name)};
}

/// The defaults, with so many vertices wanted.
inline Options options_with(int vertices) {
    Options options;
    options.vertices = vertices;
    return options;
}

}  // namespace kinequad::test
