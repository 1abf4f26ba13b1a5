#pragma once

#include <array>

#include "kinequad/core/types.h"

namespace kinequad {

/// The corners of one quad in space, counter-clockwise.
using QuadCorners = std::array<Vector3, 4>;

/// When a quad counts as badly shaped, in `quad_cost`.
struct FoldBarrier {
    double safe_jacobian = 0.4;  ///< scaled Jacobian below which a corner is pushed open
    double weight = 4;           ///< of the square of what is missing
};

/// Normal of a quad by its diagonals; its length is twice the area of the quad's shadow along it.
Vector3 area_normal(const QuadCorners& corners);

/// The corner, 0 or 1, at which the shorter diagonal of a quad begins; it ends two corners on.
std::size_t end_of_cut(const QuadCorners& corners);

/// Quads `Q` over vertices `X` as triangles, cut along the shorter diagonal: 2q and 2q + 1 are the
/// halves of quad q.
Triangles cut_quads(const Quads& Q, const Positions& X);

/// Smallest scaled Jacobian over the corners, in [-1, 1]; positive where the quad is not folded.
double least_scaled_jacobian(const QuadCorners& corners);

/// Sum over the corners of the squared cosine, plus the barrier's penalty of corners close to
/// folding. 0 for a rectangle; not changed by rigid motion and scale.
double quad_cost(const QuadCorners& corners, const FoldBarrier& barrier);

/// The cosine of one corner of a quad, and how it changes with a vertex of that quad.
struct CornerCosine {
    double cosine = 0;
    Vector3 gradient = Vector3::Zero();
};

/// The cosines of those corners whose angle depends on vertex `corner` (0 to 3): its own and its
/// neighbours', with their gradients by its position. Sides without length give no numbers.
std::array<CornerCosine, 3> cosines_at(const QuadCorners& corners, std::size_t corner);

/// Where corner `corner` lies on the square that fits the quad best in the plane across `normal`
/// (unit).
Vector3 fitted_square_corner(const QuadCorners& corners, const Vector3& normal, std::size_t corner);

}  // namespace kinequad
