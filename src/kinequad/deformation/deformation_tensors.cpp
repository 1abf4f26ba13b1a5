#include "kinequad/deformation/deformation_tensors.h"

namespace kinequad {

DeformationTensors add_tensors(const DeformationTensors& a, const DeformationTensors& b) {
    DeformationTensors sum;
    sum.frame_count = a.frame_count + b.frame_count;
    sum.stretch_direction_sum = a.stretch_direction_sum + b.stretch_direction_sum;
    sum.stretch_sum = a.stretch_sum + b.stretch_sum;
    sum.stretch_square_sum = a.stretch_square_sum + b.stretch_square_sum;
    sum.curvature = (a.curvature + b.curvature) / 2;
    return sum;
}

}  // namespace kinequad
