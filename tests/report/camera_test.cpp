#include "kinequad/report/camera.h"

#include <gtest/gtest.h>

#include "kinequad/core/error.h"
#include "support/shapes.h"

namespace kinequad {
namespace {

TEST(FitCamera, FrontSeesYUpFiguresFromPlusZAndZUpFiguresFromMinusY) {
    const Positions V = test::cube().V;
    const Camera y_up = fit_camera(V, named_viewpoint("front", UpAxis::y));
    EXPECT_TRUE(y_up.toward.isApprox(Vector3::UnitZ()));
    EXPECT_TRUE(y_up.up.isApprox(Vector3::UnitY()));
    const Camera z_up = fit_camera(V, named_viewpoint("front", UpAxis::z));
    EXPECT_TRUE(z_up.toward.isApprox(-Vector3::UnitY()));
    EXPECT_TRUE(z_up.up.isApprox(Vector3::UnitZ()));
    EXPECT_TRUE(z_up.right.isApprox(Vector3::UnitX()));
}

TEST(FitCamera, FrameIsRightHandedAndHoldsEveryPoint) {
    Positions V = test::cube().V;
    V.rowwise() += Eigen::RowVector3d(5, -2, 7);
    for (const char* name : {"front", "left", "back", "right", "top", "quarter"}) {
        for (const UpAxis up : {UpAxis::y, UpAxis::z}) {
            const Camera camera = fit_camera(V, named_viewpoint(name, up));
            Eigen::Matrix3d frame;
            frame << camera.right, camera.up, camera.toward;
            EXPECT_TRUE((frame.transpose() * frame).isIdentity(1e-12)) << name;
            EXPECT_NEAR(frame.determinant(), 1, 1e-12) << name;
            double most_right = 0;
            double most_up = 0;
            for (Eigen::Index v = 0; v < V.rows(); ++v) {
                const Vector3 seen = frame.transpose() * (V.row(v).transpose() - camera.center);
                most_right = std::max(most_right, std::abs(seen.x()));
                most_up = std::max(most_up, std::abs(seen.y()));
            }
            EXPECT_NEAR(most_right, camera.half_width, 1e-12) << name;
            EXPECT_NEAR(most_up, camera.half_height, 1e-12) << name;
        }
    }
}

TEST(NamedViewpoint, RefusesUnknownNames) { EXPECT_THROW(named_viewpoint("below"), InputError); }

/// Expects that `V` is inside of the camera's box.
void expect_in_picture(const Positions& V, const Camera& camera) {
    const Positions off = V.rowwise() - camera.center.transpose();
    EXPECT_LE((off * camera.right).cwiseAbs().maxCoeff(), camera.half_width * (1 + 1e-12));
    EXPECT_LE((off * camera.up).cwiseAbs().maxCoeff(), camera.half_height * (1 + 1e-12));
}

TEST(Camera, UnitedHoldsWhatBothHold) {
    const Positions a = test::sphere(2).V;
    const Positions b = (0.5 * a).rowwise() + Eigen::RowVector3d(3, 1, -2);
    const Viewpoint viewpoint{20, 30, UpAxis::z};
    const Camera united = unite_cameras(fit_camera(a, viewpoint), fit_camera(b, viewpoint));
    Positions both(2 * a.rows(), 3);
    both << a, b;
    expect_in_picture(both, united);
    const Camera expected = fit_camera(both, viewpoint);
    EXPECT_NEAR(united.half_width, expected.half_width, 1e-12);
    EXPECT_NEAR(united.half_height, expected.half_height, 1e-12);
}

TEST(Camera, TurntableGoesOnceAroundWithoutAJump) {
    Positions V = test::torus(20, 10).V;
    V.col(0) *= 2;
    V.rowwise() += Eigen::RowVector3d(5, -1, 2);
    const std::vector<Camera> cameras = turntable_cameras(V, named_viewpoint("quarter"), 8);
    ASSERT_EQ(cameras.size(), 8U);
    EXPECT_TRUE(cameras[0].toward.isApprox(fit_camera(V, named_viewpoint("quarter")).toward));
    Vector3 sum = Vector3::Zero();
    for (const Camera& camera : cameras) {
        expect_in_picture(V, camera);
        EXPECT_EQ(camera.center, cameras[0].center);
        EXPECT_EQ(camera.half_width, cameras[0].half_width);
        sum += camera.right;
    }
    EXPECT_NEAR(sum.norm(), 0, 1e-12);
    EXPECT_NEAR(cameras[0].right.dot(cameras[2].right), 0, 1e-12);
}

}  // namespace
}  // namespace kinequad
