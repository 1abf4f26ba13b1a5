#include "kinequad/pipeline/refine_coarse_input.h"

#include <fmt/format.h>

#include "kinequad/gridmap/compute_grid_map.h"
#include "kinequad/mesh/refine_long_edges.h"

namespace kinequad {
namespace {

/// Length of the longest edge that is left, in quad edges.
constexpr double longest_edge = 2;
/// What refinement has to multiply the triangles of a symmetric run by: a symmetry map is best made
/// of the triangles that were given.
constexpr int least_growth = 2;

}  // namespace

std::optional<RefinedMesh> refine_coarse_input(const Topology& topology, const Positions& V,
                                               const std::vector<int>& features,
                                               const Options& options, const Context& context) {
    const IntrinsicMetric metric = metric_of(topology, V);
    const double quad_edge = options.edge_length > 0
                                 ? options.edge_length
                                 : edge_length_for(topology, metric, options.vertices);
    if (!(quad_edge > 0)) return std::nullopt;
    RefineOptions refine_options;
    refine_options.longest_edge = longest_edge * quad_edge;
    refine_options.lines = features;
    RefinedMesh refined = refine_long_edges(topology, metric, refine_options, context);
    const bool is_symmetric = options.symmetry != SymmetryMode::none;
    const int least_triangles =
        is_symmetric ? least_growth * topology.triangle_count : topology.triangle_count + 1;
    if (refined.F.rows() < least_triangles) return std::nullopt;
    context.write_log(LogLevel::info,
                      fmt::format("check: the mesh is coarse against the quads; refined from {} to "
                                  "{} triangles",
                                  topology.triangle_count, refined.F.rows()));
    return refined;
}

}  // namespace kinequad
