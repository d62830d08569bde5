#pragma once
// What scene.3Dscene and the live window draw alike.
#include <mrpt/img/TColor.h>
#include <mrpt/opengl/CSetOfLines.h>
#include <mrpt/opengl/CSetOfTriangles.h>

#include <array>

#include "slamot/core/data/Pose2.h"

namespace slamot::run {

/// Colours that colour-blind people can tell apart (Okabe and Ito), as in figures.
namespace shape_colour {
inline const mrpt::img::TColor robot(0, 114, 178), landmark(34, 34, 34), sight(86, 180, 233);
inline const std::array tracks{mrpt::img::TColor(213, 94, 0), mrpt::img::TColor(204, 121, 167),
                               mrpt::img::TColor(230, 159, 0)};
inline const mrpt::img::TColorf background(0.96f, 0.96f, 0.96f);
}  // namespace shape_colour

/// The robot's mark, a metre long, its heading along x.
mrpt::opengl::CSetOfTriangles::Ptr makeRobotArrow();

/// Outlines at three standard deviations; still without a place. MRPT 2.5's CEllipsoid2D draws other ellipses:
/// of U U^t where the covariance is U^t U.
mrpt::opengl::CSetOfLines::Ptr makeEllipse(const mrpt::img::TColor& colour);
void placeEllipse(mrpt::opengl::CSetOfLines& ellipse, const Vector2& mean, const Matrix2& covariance);

}  // namespace slamot::run
