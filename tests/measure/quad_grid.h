#pragma once

#include <numbers>

#include "kinequad/core/types.h"

namespace kinequad::test {

/// One degree in radians.
inline constexpr double degree = std::numbers::pi / 180;

/// Unit square in z = 0 as `n` x `n` quads.
struct QuadGrid {
    Positions X;
    Quads Q;
};

inline QuadGrid quad_grid(int n) {
    QuadGrid grid;
    grid.X.resize((n + 1) * (n + 1), 3);
    grid.Q.resize(n * n, 4);
    for (int i = 0; i <= n; ++i) {
        for (int j = 0; j <= n; ++j) grid.X.row(i * (n + 1) + j) << double(j) / n, double(i) / n, 0;
    }
    for (int i = 0; i < n; ++i) {
        for (int j = 0; j < n; ++j) {
            const int a = i * (n + 1) + j;
            grid.Q.row(i * n + j) << a, a + 1, a + n + 2, a + n + 1;
        }
    }
    return grid;
}

/// The quads of a cube with corners at +-1.
inline QuadGrid quad_cube() {
    QuadGrid cube;
    cube.X.resize(8, 3);
    for (int i = 0; i < 8; ++i) {
        cube.X.row(i) << (i & 1 ? 1 : -1), (i & 2 ? 1 : -1), (i & 4 ? 1 : -1);
    }
    cube.Q.resize(6, 4);
    cube.Q << 0, 2, 3, 1, 4, 5, 7, 6, 0, 1, 5, 4, 2, 6, 7, 3, 0, 4, 6, 2, 1, 3, 7, 5;
    return cube;
}

}  // namespace kinequad::test
