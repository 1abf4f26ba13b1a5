#pragma once

#include <array>
#include <string>
#include <vector>

#include "kinequad/core/context.h"
#include "kinequad/core/types.h"
#include "kinequad/mesh/topology.h"

namespace kinequad {

/// An edge and all triangles along it, ascending.
struct EdgeFinding {
    int a = -1;
    int b = -1;
    std::vector<int> triangles;
};

/// What was found in a triangle mesh; numbers are those of the input, lists are ascending.
/// docs/robustness.md
struct MeshReport {
    int vertices = 0;
    int triangles = 0;

    // What a run refuses.
    std::vector<int> wild_triangles;       ///< name a vertex that does not exist
    std::vector<int> collapsed_triangles;  ///< name a vertex twice
    /// {earlier, later}: triangles with the same three vertices, whichever way round.
    std::vector<std::array<int, 2>> duplicate_triangles;
    std::vector<EdgeFinding> non_manifold_edges;  ///< with more than two triangles
    std::vector<EdgeFinding> misoriented_edges;   ///< that two triangles run along the same way
    std::vector<int> non_manifold_vertices;       ///< whose triangles form more than one fan
    /// The lowest triangle of each connected part that cannot be oriented, such as a Moebius strip.
    std::vector<int> unorientable_parts;

    // What a run can do with.
    std::vector<int> isolated_vertices;  ///< that no triangle names
    std::vector<int> flat_triangles;     ///< without area, up to rounding
    /// {earlier, later}: vertices at the same place.
    std::vector<std::array<int, 2>> coincident_vertices;
    /// Pairs of triangles without a common vertex that pass through one another.
    std::vector<std::array<int, 2>> crossing_triangles;
    bool has_more_crossings = false;  ///< the search stopped at its limit

    /// Of a surface that a run accepts; zeros otherwise.
    SurfaceCounts counts;
    int genus = 0;  ///< of all components together

    /// Whether `build_topology` accepts the mesh.
    bool is_accepted() const;
};

/// How much is looked for.
struct MeshCheckOptions {
    /// Most pairs of crossing triangles that are listed; 0: they are not searched.
    int most_crossings = 0;
};

/// Looks for everything in the mesh `F` (m x 3) with vertices at `V` (n x 3, finite) that is or
/// may be wrong. Never throws for what it finds; `Cancelled`.
MeshReport check_mesh(const Triangles& F, const Positions& V, const MeshCheckOptions& options,
                      const Context& context);

/// One line for everything found that a run refuses, each naming its first elements and what can be
/// done about it.
std::vector<std::string> describe_refusals(const MeshReport& report);
/// One line for everything found that a run can do with.
std::vector<std::string> describe_remarks(const MeshReport& report);

/// "3, 17, 40 and 12 more": the first of `elements`.
std::string list_elements(const std::vector<int>& elements);

}  // namespace kinequad
