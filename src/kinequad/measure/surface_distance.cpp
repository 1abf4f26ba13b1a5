#include "kinequad/measure/surface_distance.h"

#include <algorithm>

#include "kinequad/core/error.h"
#include "kinequad/measure/directed_distance.h"

namespace kinequad {
namespace {

void place(std::unique_ptr<ClosestPoints>& surface, const TriangleMesh& mesh) {
    if (surface == nullptr) {
        surface = std::make_unique<ClosestPoints>(mesh.V, mesh.F);
    } else {
        surface->update(mesh.V, mesh.F);
    }
}

}  // namespace

double SurfaceDistance::hausdorff_percent() const {
    return std::max(quads_to_input.hausdorff_percent, input_to_quads.hausdorff_percent);
}

double SurfaceDistance::hausdorff_bound_percent() const {
    return std::max(quads_to_input.hausdorff_bound_percent, input_to_quads.hausdorff_bound_percent);
}

double SurfaceDistance::mean_percent() const {
    return std::max(quads_to_input.mean_percent, input_to_quads.mean_percent);
}

SurfaceDistanceMeter::SurfaceDistanceMeter(DistanceOptions options) : options_(options) {
    require(options.spacing_percent > 0, InputFault::usage,
            "the spacing of distance samples must be positive");
}

SurfaceDistance SurfaceDistanceMeter::measure(const ClosestPoints& input, const TriangleMesh& quads,
                                              const Context& context) {
    place(quads_, quads);
    const Positions& V = input.positions();
    const double diagonal = bounding_box_diagonal(V);
    require(
        diagonal > 0, InputFault::mesh,
        "all vertices of the input are in one place; distances relative to its size mean nothing");
    SurfaceDistance result;
    result.quads_to_input = measure_directed_distance(quads.V, quads.F, input, diagonal, options_,
                                                      quads_hints_, context);
    result.input_to_quads = measure_directed_distance(V, input.triangles(), *quads_, diagonal,
                                                      options_, input_hints_, context);
    return result;
}

SurfaceDistance measure_distance(const TriangleMesh& input, const TriangleMesh& quads,
                                 const DistanceOptions& options, const Context& context) {
    return SurfaceDistanceMeter(options).measure(ClosestPoints(input.V, input.F), quads, context);
}

}  // namespace kinequad
