#pragma once

#include "kinequad/mesh/triangle_mesh.h"

namespace kinequad::test {

/// Regular tetrahedron, closed, 4 triangles.
TriangleMesh tetrahedron();
/// Cube of edge length 2 around the origin; each side is divided into `n` x `n` squares, each cut
/// in two.
TriangleMesh cube(int n = 1);
/// Unit sphere: an octahedron divided `levels` times, 8 * 4^levels triangles.
TriangleMesh sphere(int levels);
/// Torus around the z-axis, `around` x `along` squares cut in two.
TriangleMesh torus(int around, int along, double big_radius = 1, double small_radius = 0.4);
/// Unit square in z = 0, `n` x `n` squares cut in two; one boundary loop.
TriangleMesh square(int n);
/// Open cylinder around the z-axis, two boundary loops.
TriangleMesh cylinder(int around, int along, double radius = 1, double height = 2);

}  // namespace kinequad::test
