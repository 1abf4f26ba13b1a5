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

}  // namespace
}  // namespace kinequad
