#include "kinequad/relax/quad_cost.h"

#include <algorithm>

#include "kinequad/core/index.h"

namespace kinequad {
namespace {

struct CornerShape {
    double cosine = 0;
    double jacobian = 0;
};

std::array<CornerShape, 4> corner_shapes(const QuadCorners& p) {
    const Vector3 normal = area_normal(p).normalized();
    std::array<Vector3, 4> edge;
    std::array<double, 4> inverse_length{};
    for (std::size_t k = 0; k < 4; ++k) {
        edge[k] = p[(k + 1) % 4] - p[k];
        // A side without length makes both corners at it count as folded.
        const double length = edge[k].norm();
        inverse_length[k] = length > 0 ? 1 / length : 0;
    }
    std::array<CornerShape, 4> shapes;
    for (std::size_t k = 0; k < 4; ++k) {
        const Vector3& out = edge[k];
        const Vector3& in = edge[(k + 3) % 4];
        const double scale = inverse_length[k] * inverse_length[(k + 3) % 4];
        shapes[k] = {out.dot(in) * scale, in.cross(out).dot(normal) * scale};
    }
    return shapes;
}

}  // namespace

Vector3 area_normal(const QuadCorners& p) { return (p[2] - p[0]).cross(p[3] - p[1]); }

std::size_t end_of_cut(const QuadCorners& p) {
    return (p[0] - p[2]).squaredNorm() <= (p[1] - p[3]).squaredNorm() ? 0 : 1;
}

Triangles cut_quads(const Quads& Q, const Positions& X) {
    Triangles F(2 * Q.rows(), 3);
    for (Eigen::Index q = 0; q < Q.rows(); ++q) {
        QuadCorners p;
        for (int i = 0; i < 4; ++i) p[at(i)] = X.row(Q(q, i)).transpose();
        const int k = static_cast<int>(end_of_cut(p));
        F.row(2 * q) << Q(q, k), Q(q, k + 1), Q(q, k + 2);
        F.row(2 * q + 1) << Q(q, k), Q(q, k + 2), Q(q, (k + 3) % 4);
    }
    return F;
}

double least_scaled_jacobian(const QuadCorners& p) {
    double least = 1;
    for (const CornerShape& corner : corner_shapes(p)) least = std::min(least, corner.jacobian);
    return least;
}

double quad_cost(const QuadCorners& p, const FoldBarrier& barrier) {
    double sum = 0;
    for (const CornerShape& corner : corner_shapes(p)) {
        const double missing = std::max(0.0, barrier.safe_jacobian - corner.jacobian);
        sum += corner.cosine * corner.cosine + barrier.weight * missing * missing;
    }
    return sum;
}

std::array<CornerCosine, 3> cosines_at(const QuadCorners& p, std::size_t corner) {
    const Vector3& here = p[corner];
    const Vector3& next = p[(corner + 1) % 4];
    const Vector3& opposite = p[(corner + 2) % 4];
    const Vector3& previous = p[(corner + 3) % 4];
    const double length = (next - here).norm();
    const double previous_length = (previous - here).norm();
    const Vector3 out = (next - here) / length;
    const Vector3 back = (previous - here) / previous_length;
    const Vector3 on = (opposite - next).normalized();
    const Vector3 before = (opposite - previous).normalized();
    // A unit vector from a corner to here turns with what of a move is across it, over its length.
    const auto across = [](const Vector3& vector, const Vector3& unit) {
        return Vector3(vector - vector.dot(unit) * unit);
    };
    return {{{out.dot(back), -across(back, out) / length - across(out, back) / previous_length},
             {-out.dot(on), across(on, out) / length},
             {-back.dot(before), across(before, back) / previous_length}}};
}

Vector3 fitted_square_corner(const QuadCorners& p, const Vector3& normal, std::size_t corner) {
    const Vector3 centre = (p[0] + p[1] + p[2] + p[3]) / 4;
    Vector3 spoke = Vector3::Zero();
    for (std::size_t k = 0; k < 4; ++k) {
        // Every corner is turned back onto the place of `corner` by quarter turns about the normal.
        const Vector3 away = p[k] - centre;
        const Vector3 flat = away - away.dot(normal) * normal;
        const Vector3 turned = normal.cross(flat);
        switch ((k + 4 - corner) % 4) {
            case 1:
                spoke -= turned / 4;
                break;
            case 2:
                spoke -= flat / 4;
                break;
            case 3:
                spoke += turned / 4;
                break;
            default:
                spoke += flat / 4;
        }
    }
    return centre + spoke;
}

}  // namespace kinequad
