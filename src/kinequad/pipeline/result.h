#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kinequad/deformation/deformation_tensors.h"
#include "kinequad/extract/mirrored_quads.h"
#include "kinequad/field/symmetrise_field.h"
#include "kinequad/gridmap/grid_map.h"
#include "kinequad/mesh/refined_mesh.h"
#include "kinequad/mesh/topology.h"
#include "kinequad/pipeline/domain.h"
#include "kinequad/pipeline/find_symmetry.h"
#include "kinequad/pipeline/options.h"
#include "kinequad/pipeline/stage_clock.h"

namespace kinequad {

/// How well quads mirror: the connectivity exactly, and how far vertices are from where the
/// symmetry map alone would put them, in percent of the bounding-box diagonal of the reference. The
/// map of the half is evened out, so this is not 0.
struct MirrorQuality {
    MirrorReport report;
    double mean_distance_percent = 0;
    double largest_distance_percent = 0;
};

/// What every stage of a run made.
struct Result {
    Options options;            ///< as given, with empty fields filled in
    double edge_length = 0;     ///< wanted edge length of the quads, in units of the input
    Topology topology;          ///< of the input
    Positions reference;        ///< n x 3: the input in the reference frame
    std::vector<int> features;  ///< edges of the input that the quads should follow
    /// The input refined, where it is too coarse for the quads; symmetry is then over this.
    std::optional<RefinedMesh> refined;
    std::optional<FoundSymmetry> symmetry;  ///< where the run made use of it
    /// How symmetric the field is; with the symmetry `field` only.
    std::optional<FieldSymmetry> field_symmetry;
    /// How the quads mirror; with the symmetry `exact` only.
    std::optional<MirrorQuality> mirror;
    Domain domain;  ///< what tensors, field and map are over
    DeformationTensors tensors;
    CrossField field;
    GridMap map;
    QuadMesh quads;  ///< on the input; of a half until both sides are joined
    /// Where the wanted density was not met, and why; a line each.
    std::vector<std::string> notes;
    std::vector<StageTime> times;  ///< of the stages in the order they ran
};

/// Called after each stage with its name and all that is there so far: to write intermediate
/// results.
using StageObserver = std::function<void(std::string_view stage, const Result& so_far)>;

}  // namespace kinequad
