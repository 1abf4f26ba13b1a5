#pragma once

#include <Eigen/Core>
#include <vector>

#include "kinequad/gridmap/map_variables.h"
#include "kinequad/gridmap/plane_form.h"

namespace kinequad {

/// Areas below this many cells count as none.
inline constexpr double least_cone_area = 1e-9;

/// Twice the signed area of the triangle between two vectors of the plane.
inline double cross_product(Complex a, Complex b) { return std::imag(std::conj(a) * b); }

/// An intrinsic triangulation of the flat cone metric of a map, by its nodes alone. Every half-edge
/// knows its displacement in the chart of its triangle, and which integer form in the unknowns y
/// that is. It stays a triangulation (all triangles of positive area) while the nodes are moved, by
/// flipping an edge where a triangle collapses. Lines inside the surface are cut open, so that no
/// node can cross them: as long as that goes on, a map of the surface
/// without a flipped triangle exists for the new positions. docs/gridmap.md, "Whole numbers"
class ConeTriangulation {
public:
    /// Copies the injective map `corners` (3m) of `mesh` and takes out every vertex that is no
    /// node. `integers` are the values of y in that map. Throws `GridMapError` where a vertex
    /// cannot be taken out.
    ConeTriangulation(const ChartedMesh& mesh, const MapVariables& variables,
                      const std::vector<Complex>& corners, const Eigen::VectorXd& integers);

    /// Moves y by `step` along a straight line. Returns false, with nothing changed, where that
    /// would bring two nodes together or push one through the boundary.
    bool move(const Eigen::VectorXd& step);
    /// Multiplies all positions by `factor`.
    void scale(double factor);
    /// Flips edges until the triangulation is Delaunay.
    void make_delaunay();
    /// Sets y, which the triangulation has reached up to rounding errors, exactly.
    void snap(const Eigen::VectorXd& integers);

    const Eigen::VectorXd& integers() const { return integers_; }
    int triangle_count() const { return static_cast<int>(alive_.size()); }
    /// Twice the area of the image of triangle `i` of the list, in cells.
    double determinant(int i) const;
    /// Derivative of `determinant(i)` by y.
    LinearForm<double> determinant_gradient(int i) const;
    /// One half-edge of every edge between nodes.
    std::vector<int> edges() const;
    /// Length in cells of the edge of a half-edge, and its derivative by y.
    double edge_length(int half_edge) const;
    LinearForm<double> edge_length_gradient(int half_edge) const;
    /// The half-edges on lines over which the apex of their triangle lies: its foot is between
    /// their ends.
    std::vector<int> overlooked_lines() const;
    /// Height in cells of the apex of the triangle of a half-edge over it, and its derivative by y.
    double height(int half_edge) const;
    LinearForm<double> height_gradient(int half_edge) const;
    /// Whether the edge of a half-edge runs from a node back to itself: around a limb, a handle or
    /// a hole.
    bool is_loop(int half_edge) const;
    /// Number of edges of the boundary loop that a half-edge belongs to, 0 inside the surface.
    int boundary_loop_size(int half_edge) const;
    /// Area of the whole map in cells: the number of quads once all is whole.
    double area() const;

private:
    bool can_flip(int h, double least) const;
    void flip(int h);
    std::vector<char> cut_lines(const ChartedMesh& mesh, std::vector<char> is_node);
    void take_out_vertices(const std::vector<char>& is_node);
    bool take_out(int v, std::vector<int>& outgoing);
    void compact();
    double time_to_collapse(int t, const std::vector<Complex>& velocity) const;
    void undo_flips(const std::vector<int>& flips);
    void merge_star(const std::vector<int>& fan, bool is_open, std::vector<int>& outgoing);
    std::vector<int> star(int start, bool& is_open) const;
    int fattest_flip(int v, const std::vector<int>& fan) const;

    // Per half-edge, three a triangle.
    std::vector<int> origin_;
    std::vector<int> twin_;
    std::vector<int> rotation_;
    std::vector<Complex> displacement_;
    std::vector<PlaneForm>
        form_;  ///< the displacement as a form in y; zero between vertices that are no nodes
    std::vector<char> is_on_line_;  ///< by vertex: on a line inside the surface
    std::vector<int> alive_;        ///< triangles in use
    std::vector<char> is_dead_;
    Eigen::VectorXd integers_;
};

}  // namespace kinequad
