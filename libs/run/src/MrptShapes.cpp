#include "slamot/run/MrptShapes.h"

#include "slamot/core/data/Ellipse.h"

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

mrpt::opengl::CSetOfLines::Ptr makeEllipse(const mrpt::img::TColor& colour) {
    auto ellipse = mrpt::opengl::CSetOfLines::Create();
    ellipse->setColor_u8(colour);
    return ellipse;
}

void placeEllipse(mrpt::opengl::CSetOfLines& ellipse, const Vector2& mean, const Matrix2& covariance) {
    constexpr double deviations = 3;
    constexpr int corners = 30;
    const std::vector<Vector2> outline = ellipseOutline(mean, covariance, deviations, corners);
    ellipse.clear();
    for (std::size_t i = 1; i < outline.size(); ++i)
        ellipse.appendLine(outline[i - 1].x(), outline[i - 1].y(), 0.0, outline[i].x(), outline[i].y(), 0.0);
}

}  // namespace slamot::run
