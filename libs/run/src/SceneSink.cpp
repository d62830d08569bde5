#include <mrpt/opengl/CGridPlaneXY.h>
#include <mrpt/opengl/COpenGLScene.h>
#include <mrpt/opengl/CSetOfLines.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "slamot/rawlog/GzFile.h"
#include "slamot/run/MrptShapes.h"
#include "slamot/run/MrptSinks.h"

namespace slamot::run {
namespace {

mrpt::opengl::CSetOfLines::Ptr ellipse(const Vector2& mean, const Matrix2& covariance,
                                        const mrpt::img::TColor& colour) {
    auto out = makeEllipse(colour);
    placeEllipse(*out, mean, covariance);
    return out;
}

}  // namespace

struct SceneSink::Impl {
    std::string folder;
    std::vector<Vector2> robot;
    std::map<TrackId, std::vector<Vector2>> tracks;

    static mrpt::opengl::CSetOfLines::Ptr path(const std::vector<Vector2>& points, const mrpt::img::TColor& colour) {
        auto lines = mrpt::opengl::CSetOfLines::Create();
        lines->setColor_u8(colour);
        lines->setLineWidth(2.0f);
        for (std::size_t i = 1; i < points.size(); ++i)
            lines->appendLine(points[i - 1].x(), points[i - 1].y(), 0, points[i].x(), points[i].y(), 0);
        return lines;
    }
};

SceneSink::SceneSink(std::string folder) : impl_(std::make_unique<Impl>()) {
    impl_->folder = std::move(folder);
}

SceneSink::~SceneSink() = default;

void SceneSink::step(const Step& step) {
    if (!step.has_detections) return;
    impl_->robot.push_back(step.estimate.robot.mean.position());
    for (const TrackEstimate& track : step.estimate.tracks) impl_->tracks[track.id].push_back(track.mean.head<2>());
}

void SceneSink::end(const RunEnd& end) {
    mrpt::opengl::COpenGLScene scene;
    double extent = 10;
    const auto reach = [&extent](const Vector2& p) { extent = std::max(extent, p.cwiseAbs().maxCoeff()); };
    for (const Vector2& p : impl_->robot) reach(p);
    for (const LandmarkEstimate& l : end.landmarks) reach(l.mean);
    const double cell = std::pow(10.0, std::floor(std::log10(extent)));
    const auto side = static_cast<float>(std::ceil(extent / cell) * cell);
    auto ground = mrpt::opengl::CGridPlaneXY::Create(-side, side, -side, side, 0.0f, static_cast<float>(0.5 * cell));
    ground->setColor(0.8f, 0.8f, 0.8f);
    scene.insert(ground);
    scene.getViewport()->setCustomBackgroundColor(shape_colour::background);

    scene.insert(Impl::path(impl_->robot, shape_colour::robot));
    std::size_t k = 0;
    for (const auto& [id, points] : impl_->tracks) scene.insert(Impl::path(points, shape_colour::tracks[k++ % shape_colour::tracks.size()]));
    for (const LandmarkEstimate& l : end.landmarks) scene.insert(ellipse(l.mean, l.covariance, shape_colour::landmark));

    const auto& [pose, covariance] = end.estimate.robot;
    scene.insert(ellipse(pose.position(), covariance.topLeftCorner<2, 2>(), shape_colour::robot));
    auto robot = makeRobotArrow();
    robot->setScale(static_cast<float>(std::max(0.5, extent / 50)));  // to be seen
    robot->setPose(mrpt::poses::CPose3D(pose.x, pose.y, 0, pose.theta, 0, 0));
    scene.insert(robot);

    writeGzFile(scene, impl_->folder + "/scene.3Dscene");
}

}  // namespace slamot::run
