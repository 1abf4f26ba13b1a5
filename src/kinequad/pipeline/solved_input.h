#pragma once

#include <optional>

#include "kinequad/io/frame_source.h"
#include "kinequad/mesh/refined_mesh.h"
#include "kinequad/mesh/topology.h"
#include "kinequad/transfer/carried_sequence.h"

namespace kinequad {

/// The surface that a run is solved on: the input, or what it is refined to.
class SolvedInput {
public:
    /// `topology` and the pose `reference` (n x 3) are those of `source`, which has to outlive
    /// this.
    SolvedInput(const FrameSource& source, const Topology& topology, const Positions& reference,
                const std::optional<RefinedMesh>& refined);

    const FrameSource& frames() const { return finer_ ? *finer_ : source_; }
    const Topology& topology() const { return topology_; }
    /// n' x 3: the pose on this surface.
    const Positions& reference() const { return reference_; }

private:
    const FrameSource& source_;
    std::optional<CarriedSequence> finer_;
    Topology topology_;
    Positions reference_;
};

}  // namespace kinequad
