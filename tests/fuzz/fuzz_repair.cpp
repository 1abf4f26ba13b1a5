// Arbitrary triangles in arbitrary places: check and repair take all of them, and what they accept
// is a mesh.
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "kinequad/mesh/check_mesh.h"
#include "kinequad/mesh/repair_mesh.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace kinequad;
    if (size < 4 || size > 400) return 0;
    const int vertices = 1 + data[0] % 24;
    const auto triangles = static_cast<Eigen::Index>((size - 1) / 3);
    Triangles F(triangles, 3);
    for (Eigen::Index i = 0; i < F.size(); ++i) {
        // One in 256 is out of range.
        const std::uint8_t byte = data[1 + i];
        F.data()[i] = byte == 255 ? 1000 : byte % vertices;
    }
    Positions V(vertices, 3);
    for (int v = 0; v < vertices; ++v) V.row(v) << v % 3, v / 3 % 3, v / 9;
    const auto check = [](const Triangles& faces, const Positions& points) {
        const MeshReport report = check_mesh(faces, points, {100}, Context{});
        describe_refusals(report);
        describe_remarks(report);
        // Accepted is what the topology can be built of.
        if (report.is_accepted()) build_topology(faces, static_cast<int>(points.rows()));
        return report;
    };
    const MeshReport before = check(F, V);
    const auto m = static_cast<std::size_t>(triangles);
    MeshDegeneracies degeneracies{std::vector<char>(m, 0), std::vector<char>(3 * m, 0),
                                  std::vector<double>(3 * m, 1)};
    for (const int t : before.flat_triangles) degeneracies.is_flat[static_cast<std::size_t>(t)] = 1;
    const MeshRepair repair = repair_mesh(F, vertices, degeneracies);
    Positions extended = V;
    const auto copies = static_cast<Eigen::Index>(repair.copied_vertices.size());
    extended.conservativeResize(vertices + copies, 3);
    for (Eigen::Index i = 0; i < copies; ++i) {
        extended.row(vertices + i) = V.row(repair.copied_vertices[static_cast<std::size_t>(i)]);
    }
    const MeshReport after = check(repair.F, extended);
    if (before.wild_triangles.empty() && !after.collapsed_triangles.empty()) std::abort();
    if (before.wild_triangles.empty() && !after.duplicate_triangles.empty() &&
        before.flat_triangles.empty()) {
        std::abort();
    }
    if (before.is_accepted() && !after.is_accepted()) std::abort();
    return 0;
}
