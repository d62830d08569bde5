#include "slamot/run/MrptShapes.h"

namespace slamot::run {

mrpt::opengl::CSetOfTriangles::Ptr makeRobotArrow() {
    const mrpt::math::TPoint3Df tip{0.5f, 0, 0}, left{-0.35f, 0.35f, 0}, notch{-0.2f, 0, 0},
        right{-0.35f, -0.35f, 0};
    auto arrow = mrpt::opengl::CSetOfTriangles::Create();
    arrow->enableLight(false);
    for (const auto& [a, b, c] : {std::array{tip, left, notch}, std::array{tip, notch, right}}) {
        mrpt::opengl::TTriangle triangle(a, b, c);
        triangle.setColor(shape_colour::robot);
        arrow->insertTriangle(triangle);
    }
    return arrow;
}

mrpt::opengl::CEllipsoid2D::Ptr makeEllipse(const mrpt::img::TColor& colour) {
    auto ellipse = mrpt::opengl::CEllipsoid2D::Create();
    ellipse->setQuantiles(3.0f);
    ellipse->set2DsegmentsCount(30);
    ellipse->setColor_u8(colour);
    return ellipse;
}

void placeEllipse(mrpt::opengl::CEllipsoid2D& ellipse, const Vector2& mean, const Matrix2& covariance) {
    mrpt::math::CMatrixDouble22 c;
    for (int i = 0; i < 2; ++i)
        for (int j = 0; j < 2; ++j) c(i, j) = covariance(i, j);
    ellipse.setCovMatrix(c);
    ellipse.setLocation(mean.x(), mean.y(), 0);
}

}  // namespace slamot::run
