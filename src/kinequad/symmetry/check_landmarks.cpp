#include "kinequad/symmetry/check_landmarks.h"

#include <fmt/format.h>

#include <set>

#include "kinequad/core/error.h"

namespace kinequad {

void check_landmarks(const Landmarks& landmarks, int vertex_count) {
    std::set<int> seen;
    const auto check = [&](int vertex) {
        if (vertex < 0 || vertex >= vertex_count) {
            throw InputError(InputFault::symmetry,
                             fmt::format("landmarks: name vertex {}, but the mesh has {} vertices, "
                                         "counted from 0",
                                         vertex, vertex_count));
        }
        if (!seen.insert(vertex).second) {
            throw InputError(InputFault::symmetry,
                             fmt::format("landmarks: vertex {} is named twice; name it in one pair "
                                         "or once as stationary",
                                         vertex));
        }
    };
    for (const auto& [a, b] : landmarks.pairs) {
        check(a);
        check(b);
    }
    for (const int vertex : landmarks.stationary) check(vertex);
    if (2 * landmarks.pairs.size() + landmarks.stationary.size() < 3) {
        throw InputError(
            InputFault::symmetry,
            fmt::format("landmarks: {} pairs and {} stationary vertices leave more than one "
                        "symmetry; give at least two pairs, or one pair and a stationary vertex",
                        landmarks.pairs.size(), landmarks.stationary.size()));
    }
}

}  // namespace kinequad
