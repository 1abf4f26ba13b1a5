#include "kinequad/pipeline/solved_input.h"

namespace kinequad {

SolvedInput::SolvedInput(const FrameSource& source, const Topology& topology,
                         const Positions& reference, const std::optional<RefinedMesh>& refined)
    : source_(source) {
    if (!refined) {
        topology_ = topology;
        reference_ = reference;
        return;
    }
    finer_.emplace(source, refined->F, vertex_points(*refined));
    topology_ = build_topology(finer_->triangles(), finer_->vertex_count());
    reference_ = finer_->carry(reference);
}

}  // namespace kinequad
