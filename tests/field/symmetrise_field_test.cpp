#include "kinequad/field/symmetrise_field.h"

#include <gtest/gtest.h>

#include "kinequad/field/compute_cross_field.h"
#include "kinequad/field/field_problem.h"
#include "kinequad/field/refine_cross_field.h"
#include "kinequad/field/verify_cross_field.h"
#include "kinequad/mesh/split_along_level.h"
#include "kinequad/symmetry/compute_mirror_map.h"
#include "kinequad/symmetry/symmetric_half.h"
#include "symmetry/symmetric_shapes.h"

namespace kinequad {
namespace {

class SymmetricField : public testing::Test {
protected:
    SymmetricField()
        : shape_(test::bumpy_ellipsoid(4)),
          topology_(build_topology(shape_.mesh.F, static_cast<int>(shape_.mesh.V.rows()))),
          metric_(metric_of(topology_, shape_.mesh.V)),
          map_(compute_mirror_map(shape_.mesh, {Vector3::UnitX(), 0, 0}, metric_, {})) {}

    FieldSymmetry symmetry_of(const CrossField& field) const {
        return measure_field_symmetry(topology_, metric_, field, map_, shape_.mesh.V, shape_.mesh.F,
                                      0.1);
    }
    /// Targets that are not symmetric at all: one direction in every triangle's own frame.
    CrossFieldTargets skew_targets() const {
        return {Eigen::VectorXcd::Constant(topology_.triangle_count, std::polar(1.0, 0.7)),
                Eigen::VectorXd::Constant(topology_.triangle_count, 0.3)};
    }

    /// Where the vertices of a refinement lie.
    Positions positions_of(const RefinedMesh& fine) const {
        Positions X(fine.vertex_count, 3);
        const std::vector<SurfacePoint> points = vertex_points(fine);
        for (std::size_t v = 0; v < points.size(); ++v) {
            X.row(static_cast<Eigen::Index>(v)) =
                position_of(points[v], shape_.mesh.V, shape_.mesh.F).transpose();
        }
        return X;
    }

    test::SymmetricShape shape_;
    Topology topology_;
    IntrinsicMetric metric_;
    SymmetryMap map_;
};

TEST_F(SymmetricField, OrbitsMakeAFieldSymmetric) {
    const CrossField skew = compute_cross_field(topology_, metric_, skew_targets(), {}, {});
    EXPECT_GT(symmetry_of(skew).mean_degrees, 5);
    const CrossFieldTargets average =
        average_over_orbits(topology_, metric_, skew, map_, 1, Context{});
    const CrossField field = compute_cross_field(topology_, metric_, average, {}, {});
    EXPECT_LT(symmetry_of(field).mean_degrees, 1);
}

TEST_F(SymmetricField, TheSymmetryTermMakesAFieldSymmetricInOneSolve) {
    CrossFieldOptions options;
    double before =
        symmetry_of(compute_cross_field(topology_, metric_, skew_targets(), options, {}))
            .mean_degrees;
    for (const double weight : {0.1, 1.0, 10.0}) {
        options.symmetry = symmetry_term(map_, weight);
        const CrossField field =
            compute_cross_field(topology_, metric_, skew_targets(), options, {});
        EXPECT_TRUE(verify_cross_field(topology_, metric_, field, options).valid());
        const double now = symmetry_of(field).mean_degrees;
        EXPECT_LT(now, before);
        before = now;
    }
    EXPECT_LT(before, 0.5);
}

TEST_F(SymmetricField, TheSymmetryTermCountsInTheEnergy) {
    // With angles of zero every triangle misses its transport, up to quarter turns.
    CrossFieldOptions options;
    options.symmetry = symmetry_term(map_, 2);
    const FieldProblem problem = make_field_problem(topology_, metric_, {}, options);
    const FieldState still{Eigen::VectorXd::Zero(topology_.triangle_count),
                           Eigen::VectorXi::Zero(topology_.edge_count)};
    const Eigen::VectorXd residual = Eigen::VectorXd::Zero(topology_.edge_count);
    double expected = 0;
    for (int t = 0; t < topology_.triangle_count; ++t) {
        const double miss = std::arg(std::polar(1.0, 4 * map_.transport[t])) / 4;
        expected += 2 * miss * miss;
    }
    EXPECT_NEAR(field_energy(problem, still, residual), expected, 1e-9 * expected);
}

TEST_F(SymmetricField, TheAverageOfASymmetricFieldIsTheFieldWhereItIsSmooth) {
    // Without targets the smoothest field of a symmetric shape, once averaged, stays where it is.
    const CrossField skew = compute_cross_field(topology_, metric_, skew_targets(), {}, {});
    const CrossField field = compute_cross_field(
        topology_, metric_, average_over_orbits(topology_, metric_, skew, map_, 3, Context{}), {},
        {});
    const CrossFieldTargets again =
        average_over_orbits(topology_, metric_, field, map_, 1, Context{});
    int near = 0;
    for (int t = 0; t < topology_.triangle_count; ++t) {
        const Complex here = std::polar(1.0, 4 * field.angle[t]);
        near += std::real(again.value[t] * std::conj(here)) > 0.9 ? 1 : 0;
    }
    EXPECT_GT(near, 0.9 * topology_.triangle_count);
}

TEST_F(SymmetricField, RefinementKeepsIndicesAndResiduals) {
    const CrossField field = compute_cross_field(topology_, metric_, skew_targets(), {}, {});
    const LevelSplit split = split_along_level(topology_, metric_, map_.height, 0.2);
    const Topology fine = build_topology(split.mesh.F, split.mesh.vertex_count);
    const IntrinsicMetric lengths = metric_of(fine, positions_of(split.mesh));
    const CrossField refined =
        refine_cross_field(field, topology_, metric_, split.mesh, fine, lengths);
    EXPECT_TRUE(verify_cross_field(fine, lengths, refined, {}).valid());
    EXPECT_EQ(refined.index.head(field.index.size()), field.index);
}

TEST_F(SymmetricField, TargetsOfAHalfPointWhereThoseOfTheWholeDo) {
    CrossFieldTargets whole = skew_targets();
    for (int t = 0; t < topology_.triangle_count; ++t) {
        whole.value[t] = std::polar(1.0, 0.37 * t);
        whole.weight[t] = 0.01 * t;
    }
    const SymmetricHalf half =
        take_symmetric_half(topology_, metric_, map_, shape_.mesh.V, shape_.mesh.F);
    const CrossFieldTargets targets = refine_targets(whole, topology_, metric_, half.mesh);
    const Positions V = positions_of(half.mesh);
    // The tangents that angles of a triangle are measured by.
    const auto tangents = [](const Positions& X, const Triangles& F, int t) {
        const Vector3 side = (X.row(F(t, 1)) - X.row(F(t, 0))).transpose();
        const Vector3 other = (X.row(F(t, 2)) - X.row(F(t, 0))).transpose();
        Eigen::Matrix<double, 3, 2> axes;
        axes.col(0) = side.normalized();
        axes.col(1) = side.cross(other).cross(side).normalized();
        return axes;
    };
    int cut = 0;
    for (int t = 0; t < static_cast<int>(half.mesh.F.rows()); ++t) {
        const int parent = half.mesh.parent[static_cast<std::size_t>(t)];
        const double angle = std::arg(whole.value[parent]) / 4;
        const Vector3 direction = tangents(shape_.mesh.V, shape_.mesh.F, parent) *
                                  Vector2(std::cos(angle), std::sin(angle));
        const Vector2 here = tangents(V, half.mesh.F, t).transpose() * direction;
        const auto expected = std::polar(1.0, 4 * std::atan2(here[1], here[0]));
        EXPECT_NEAR(std::abs(targets.value[t] - expected), 0, 1e-6) << t;
        EXPECT_EQ(targets.weight[t], whole.weight[parent]);
        if (half.mesh.F.row(t) != shape_.mesh.F.row(parent)) ++cut;
    }
    EXPECT_GT(cut, 0);
}

}  // namespace
}  // namespace kinequad
