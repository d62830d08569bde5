#include "slamot/run/MrptShapes.h"

namespace slamot::run {

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
