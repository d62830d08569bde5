#pragma once
// What scene.3Dscene and the live window draw alike.
#include <mrpt/img/TColor.h>
#include <mrpt/opengl/CEllipsoid2D.h>

#include <array>

#include "slamot/core/data/Pose2.h"

namespace slamot::run {

/// Colours that colour-blind people can tell apart (Okabe and Ito), as in figures.
namespace shape_colour {
inline const mrpt::img::TColor robot(0, 114, 178), landmark(0, 158, 115), sight(86, 180, 233);
inline const std::array tracks{mrpt::img::TColor(213, 94, 0), mrpt::img::TColor(204, 121, 167),
                               mrpt::img::TColor(230, 159, 0)};
}  // namespace shape_colour

/// At three standard deviations; still without a place.
mrpt::opengl::CEllipsoid2D::Ptr makeEllipse(const mrpt::img::TColor& colour);
void placeEllipse(mrpt::opengl::CEllipsoid2D& ellipse, const Vector2& mean, const Matrix2& covariance);

}  // namespace slamot::run
