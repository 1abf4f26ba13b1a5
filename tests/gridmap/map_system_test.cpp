#include "kinequad/gridmap/map_system.h"

#include <gtest/gtest.h>

#include "gridmap/map_checks.h"

namespace kinequad {
namespace {

std::vector<test::Surface> tiny_surfaces() {
    return {test::surface_of(test::tetrahedron(), "tetrahedron"),
            test::surface_of(test::square(2), "square"),
            test::surface_of(test::cylinder(6, 2), "cylinder"), test::flat_torus(3, 3)};
}

TEST(TargetShape, FindsThePartsOfALinearMap) {
    const test::PreparedMap map = test::prepare(test::surface_of(test::sphere(1)), 40);
    const Complex a(0.7, -0.4);
    const Complex b(-0.2, 0.5);
    for (int t = 0; t < map.mesh.triangle_count(); ++t) {
        std::array<Complex, 3> z;
        for (int k = 0; k < 3; ++k) {
            const Complex q = map.mesh.target[at(3 * t + k)];
            z[at(k)] = a * q + b * std::conj(q) + Complex(3, 4);
        }
        const TargetShape& shape = map.shapes[at(t)];
        EXPECT_LT(std::abs(shape.conformal_part(z.data()) - a), 1e-12);
        EXPECT_LT(std::abs(shape.anticonformal_part(z.data()) - b), 1e-12);
    }
}

TEST(TargetShape, FunctionalsAreTheDerivativesOfTheParts) {
    const test::PreparedMap map = test::prepare(test::surface_of(test::tetrahedron()), 10);
    const TargetShape& shape = map.shapes[1];
    const Complex direction(0.3, -1.7);
    const std::array<Complex, 3> z = {Complex(1, 2), Complex(-0.5, 0.25), Complex(2, -1)};
    for (const bool anti : {false, true}) {
        const auto value = [&](const std::array<Complex, 3>& at_z) {
            const Complex part =
                anti ? shape.anticonformal_part(at_z.data()) : shape.conformal_part(at_z.data());
            return std::real(std::conj(direction) * part);
        };
        const Vector6 functional = shape.functional(direction, anti);
        for (int i = 0; i < 6; ++i) {
            std::array<Complex, 3> moved = z;
            moved[at(i / 2)] += i % 2 == 0 ? Complex(1, 0) : Complex(0, 1);
            EXPECT_NEAR(value(moved) - value(z), functional[i], 1e-12);
        }
    }
}

TEST(TargetShapes, AreasAreThoseOfTheChartsAndScale) {
    for (const test::Surface& surface : test::map_surfaces()) {
        const test::PreparedMap map = test::prepare(surface, 300);
        double area = 0;
        for (const TargetShape& shape : map.shapes) area += shape.area;
        EXPECT_NEAR(area, 300, 1e-6) << surface.name;
        area = 0;
        for (const TargetShape& shape : target_shapes(map.mesh, 3)) area += shape.area;
        EXPECT_NEAR(area, 2700, 1e-5) << surface.name;
    }
}

TEST(TargetShapes, SliversAreFattened) {
    TriangleMesh mesh = test::square(1);
    mesh.V.row(0) << 1, 1e-9, 0;
    mesh.V.row(1) << 0, 0, 0;
    mesh.V.row(2) << 2, 0, 0;
    mesh.V.row(3) << 1, 2, 0;
    mesh.F.resize(2, 3);
    mesh.F << 1, 2, 0, 0, 2, 3;
    const Topology topology = build_topology(mesh.F, 4);
    CrossField field;
    field.angle = Eigen::VectorXd::Zero(2);
    field.period_jump = Eigen::VectorXi::Zero(topology.edge_count);
    field.index = Eigen::VectorXi::Zero(4);
    const ChartedMesh charts = build_charts(topology, metric_of(topology, mesh.V), field, 1);
    const std::vector<TargetShape> shapes = target_shapes(charts, 1);
    EXPECT_GT(shapes[0].area, 1e-6);
    EXPECT_LT(shapes[0].area, 1e-3);
    for (const Complex& g : shapes[0].gradient) EXPECT_LT(std::abs(g), 1e6);
}

Eigen::MatrixXd dense_rows(const MapVariables& variables) {
    const auto rows = static_cast<Eigen::Index>(variables.row_start.size()) - 1;
    Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(rows, variables.columns());
    for (Eigen::Index r = 0; r < rows; ++r) {
        for (int i = variables.row_start[static_cast<std::size_t>(r)];
             i < variables.row_start[static_cast<std::size_t>(r + 1)]; ++i) {
            dense(r, variables.column[at(i)]) += variables.coefficient[at(i)];
        }
    }
    return dense;
}

TEST(TriangleSystem, SumsUpLikeADenseProduct) {
    std::mt19937 random(4);
    for (const test::Surface& surface : tiny_surfaces()) {
        SCOPED_TRACE(surface.name);
        const MapVariables variables = test::prepare(surface, 20).variables;
        TriangleSystem system(variables);
        const Eigen::MatrixXd rows = dense_rows(variables);
        const auto triangles = static_cast<int>(rows.rows() / 6);
        std::vector<Matrix6> matrices;
        std::vector<Vector6> vectors;
        for (int t = 0; t < triangles; ++t) {
            const Vector6 a = test::random_vector(6, random);
            const Vector6 b = test::random_vector(6, random);
            matrices.emplace_back(a * a.transpose() - 0.5 * b * b.transpose());
            vectors.push_back(a + b);
        }
        Eigen::MatrixXd expected = Eigen::MatrixXd::Zero(variables.columns(), variables.columns());
        Eigen::VectorXd expected_sum = Eigen::VectorXd::Zero(variables.columns());
        for (int t = 0; t < triangles; ++t) {
            const Eigen::MatrixXd own = rows.middleRows<6>(6 * t);
            expected += own.transpose() * matrices[at(t)] * own;
            expected_sum += own.transpose() * vectors[at(t)];
        }
        for (int w = 0; w < variables.position_count; ++w) {
            Eigen::VectorXd form = Eigen::VectorXd::Zero(variables.columns());
            for (const auto& [c, f] : variables.whole[at(w)])
                form[variables.vertex_columns + c] += f;
            expected += 1.75 * form * form.transpose();
        }
        // Twice: nothing of the first sum may be left in the second.
        system.assemble([](int) -> Matrix6 { return Matrix6::Ones(); }, 3);
        const Eigen::MatrixXd lower = system.assemble([&](int t) { return matrices[at(t)]; }, 1.75);
        const Eigen::MatrixXd expected_lower = expected.triangularView<Eigen::Lower>();
        EXPECT_LT((lower - expected_lower).cwiseAbs().maxCoeff(), 1e-10);
        const Eigen::VectorXd sum = system.gather([&](int t) { return vectors[at(t)]; });
        EXPECT_LT((sum - expected_sum).cwiseAbs().maxCoeff(), 1e-10);
    }
}

}  // namespace
}  // namespace kinequad
