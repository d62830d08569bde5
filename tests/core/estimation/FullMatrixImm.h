#pragma once
// The IMM on the joint state as the textbook writes it: full matrices D, H and P for every combination of
// modes, densities by inverse and determinant, Jacobians by automatic differentiation. What JointImm is held
// to.
#include <Eigen/Dense>
#include <cmath>
#include <map>
#include <vector>

#include "slamot/core/data/Detections.h"
#include "slamot/core/estimation/Blocks.h"
#include "slamot/core/estimation/TargetModes.h"
#include "slamot/core/models/RangeBearing.h"
#include "slamot/core/models/RobotMotion.h"
#include "support/AutoDiff.h"

namespace slamot::test {

class FullMatrixImm {
  public:
    struct Gaussian {
        Eigen::VectorXd x;
        Eigen::MatrixXd P;
    };
    using Combination = std::vector<int>;  ///< the mode of each target

    FullMatrixImm(const ImmParameters& imm, Consistency consistency, const PoseGaussian& start)
        : imm_(imm), invariant_(consistency == Consistency::invariant) {
        modes_[{}] = {1.0, {start.mean.vector(), start.covariance}};
    }

    // State: robot, then objects in the order they came.
    struct Object {
        int id, size;  // size 6: target, 2: landmark
    };

    void predict(const RobotMotionParameters& motion, const OdometryIncrement& odometry) {
        const Eigen::MatrixXd p = chainOf(imm_).over(odometry.seconds());
        std::map<Combination, std::pair<double, Gaussian>> mixed;
        for (const auto& [to, unused] : modes_) {
            std::vector<std::pair<double, Gaussian>> parts;
            double c = 0;
            for (const auto& [from, mode] : modes_) {
                double w = mode.first;
                for (std::size_t t = 0; t < to.size(); ++t) w *= p(from[t], to[t]);
                parts.push_back({w, mode.second});
                c += w;
            }
            for (auto& part : parts) part.first /= c;
            mixed[to] = {c, mixture(parts)};
        }
        modes_ = std::move(mixed);
        for (auto& [combination, mode] : modes_) {
            Gaussian& g = mode.second;
            const MotionPrediction f = predictMotion(motion, Vector3(g.x.head<3>()), odometry);
            Eigen::MatrixXd A = Eigen::MatrixXd::Identity(g.x.size(), g.x.size()), Q = 0 * A;
            A.topLeftCorner<3, 3>() = f.F;
            Q.topLeftCorner<3, 3>() = f.Q;
            g.x.head<3>() = f.pose;
            int t = 0;
            for (const Object& object : objects_) {
                if (object.size != 6) continue;
                const int at = offset(object.id);
                TargetModel model = imm_.modes[static_cast<std::size_t>(combination[t++])].model;
                model.noise_interval = imm_.noise_interval;
                const TargetPrediction m = predictTarget(model, g.x.segment<6>(at), odometry.seconds());
                g.x.segment<6>(at) = m.mean;
                A.block<6, 6>(at, at) = m.F;
                Q.block<6, 6>(at, at) = m.Q;
            }
            g.P = A * g.P * A.transpose() + Q;
        }
    }

    /// Detections of known objects, landmarks first.
    void update(const std::vector<std::pair<int, RangeBearingDetection>>& batch) {
        double sum = 0;
        for (auto& [combination, mode] : modes_) sum += mode.first *= condition(mode.second, batch);
        for (auto& [combination, mode] : modes_) mode.first /= sum;
    }

    void add(int id, int size, const RangeBearingDetection& detection, double velocity_std,
             double acceleration_std) {
        for (auto& [combination, mode] : modes_)
            augment(mode.second, size, detection, velocity_std, acceleration_std);
        objects_.push_back({id, size});
        if (size != 6) return;
        std::map<Combination, std::pair<double, Gaussian>> split;
        const Eigen::VectorXd initial = initialProbabilities(imm_);
        for (const auto& [combination, mode] : modes_)
            for (int j = 0; j < initial.size(); ++j) {
                Combination longer = combination;
                longer.push_back(j);
                split[longer] = {mode.first * initial(j), mode.second};
            }
        modes_ = std::move(split);
    }

    void remove(int id) {
        const int at = offset(id);
        int t = 0;
        for (const Object& object : objects_) {
            if (object.id == id) break;
            t += object.size == 6;
        }
        std::map<Combination, std::vector<std::pair<double, Gaussian>>> groups;
        for (const auto& [combination, mode] : modes_) {
            Combination shorter = combination;
            shorter.erase(shorter.begin() + t);
            const auto n = mode.second.x.size();
            std::vector<Eigen::Index> kept;
            for (Eigen::Index i = 0; i < n; ++i)
                if (i < at || i >= at + 6) kept.push_back(i);
            groups[shorter].push_back({mode.first, {mode.second.x(kept), mode.second.P(kept, kept)}});
        }
        for (std::size_t i = 0; i < objects_.size(); ++i)
            if (objects_[i].id == id) objects_.erase(objects_.begin() + static_cast<std::ptrdiff_t>(i--));
        modes_.clear();
        for (auto& [combination, parts] : groups) {
            double c = 0;
            for (const auto& part : parts) c += part.first;
            for (auto& part : parts) part.first /= c;
            modes_[combination] = {c, mixture(parts)};
        }
    }

    bool knows(int id) const { return offset(id) > 0; }
    int offset(int id) const {
        int at = 3;
        for (const Object& object : objects_) {
            if (object.id == id) return at;
            at += object.size;
        }
        return -1;
    }
    Gaussian combined() const {
        std::vector<std::pair<double, Gaussian>> parts;
        for (const auto& [combination, mode] : modes_) parts.push_back(mode);
        return mixture(parts);
    }
    double probability(int target, int mode) const {
        double sum = 0;
        for (const auto& [combination, each] : modes_)
            if (combination[static_cast<std::size_t>(target)] == mode) sum += each.first;
        return sum;
    }

  private:
    /// J dx on all 2-vectors, heading left out.
    static Eigen::MatrixXd D(const Eigen::VectorXd& dx) {
        Eigen::MatrixXd out = Eigen::MatrixXd::Identity(dx.size(), dx.size());
        for (Eigen::Index i = 0; i < dx.size(); i += i == 0 ? 3 : 2) {
            out(i, 2) += -dx(i + 1);
            out(i + 1, 2) += dx(i);
        }
        return out;
    }

    Gaussian mixture(const std::vector<std::pair<double, Gaussian>>& parts) const {
        std::size_t r = 0;
        for (std::size_t i = 0; i < parts.size(); ++i)
            if (parts[i].first > parts[r].first) r = i;
        const Eigen::VectorXd x_r = parts[r].second.x;
        const auto difference = [&x_r](const Eigen::VectorXd& x) {
            Eigen::VectorXd dx = x - x_r;
            dx(2) = wrapAngle(dx(2));
            return dx;
        };
        Eigen::VectorXd mean = 0 * x_r;
        for (const auto& [w, g] : parts) mean += w * difference(g.x);
        Eigen::MatrixXd P = Eigen::MatrixXd::Zero(x_r.size(), x_r.size());
        for (const auto& [w, g] : parts) {
            const Eigen::VectorXd dx = difference(g.x);
            const Eigen::MatrixXd T =
                invariant_ ? D(-dx) : Eigen::MatrixXd(Eigen::MatrixXd::Identity(P.rows(), P.rows()));
            P += w * (T * g.P * T.transpose() + (dx - mean) * (dx - mean).transpose());
        }
        if (invariant_) P = D(mean) * P * D(mean).transpose();
        Gaussian out{x_r + mean, P};
        out.x(2) = wrapAngle(out.x(2));
        return out;
    }

    static double density(const Eigen::VectorXd& nu, const Eigen::MatrixXd& S) {
        if (nu.size() == 0) return 1;
        return std::exp(-0.5 * nu.dot(S.inverse() * nu)) / std::sqrt((2 * pi * S).determinant());
    }

    /// EKF update; gives the likelihood of the targets' rows.
    double condition(Gaussian& g, const std::vector<std::pair<int, RangeBearingDetection>>& batch) const {
        const auto n = g.x.size(), m = static_cast<Eigen::Index>(2 * batch.size());
        if (m == 0) return 1;
        Eigen::MatrixXd H = Eigen::MatrixXd::Zero(m, n), R = Eigen::MatrixXd::Zero(m, m);
        Eigen::VectorXd nu(m);
        Eigen::Index landmark_rows = 0;
        for (Eigen::Index i = 0; i < m; i += 2) {
            const auto& [id, detection] = batch[static_cast<std::size_t>(i / 2)];
            const int at = offset(id);
            for (const Object& object : objects_)
                if (object.id == id && object.size == 2) landmark_rows = i + 2;
            Eigen::Matrix<double, 5, 1> y;
            y << g.x.head<3>(), g.x.segment<2>(at);
            const auto h = [](const auto& v) {
                using S = std::decay_t<decltype(v(0))>;
                return rangeBearing<S>(Eigen::Matrix<S, 3, 1>(v.template head<3>()),
                                       Eigen::Matrix<S, 2, 1>(v.template tail<2>()), Pose2{});
            };
            const Eigen::Matrix<double, 2, 5> Hy = jacobian<5>(h, y);
            H.block<2, 3>(i, 0) = Hy.leftCols<3>();
            H.block<2, 2>(i, at) = Hy.rightCols<2>();
            nu.segment<2>(i) = rangeBearingResidual(detection.z(), h(y));
            R.block<2, 2>(i, i) = detection.covariance;
            if (!invariant_) continue;
            const Vector2 e = y.tail<2>() - y.head<2>();
            const Vector2 t = quarterTurn() * e.normalized();
            Eigen::VectorXd across = Eigen::VectorXd::Zero(n);
            across.segment<2>(at) = t;
            across.head<2>() = -t;
            const double P_lat = across.dot(g.P * across), d = e.norm();
            nu(i) -= P_lat / (2 * d);
            R(i, i) += 0.5 * std::pow(P_lat / d, 2);
        }
        const Eigen::MatrixXd S = H * g.P * H.transpose() + R;
        const Eigen::MatrixXd K = g.P * H.transpose() * S.inverse();
        const Eigen::MatrixXd A = Eigen::MatrixXd::Identity(n, n) - K * H;
        const Eigen::VectorXd dx = K * nu;
        g.x += dx;
        g.x(2) = wrapAngle(g.x(2));
        g.P = A * g.P * A.transpose() + K * R * K.transpose();
        if (invariant_) g.P = D(dx) * g.P * D(dx).transpose();
        const Eigen::Index rows = m - landmark_rows;
        if (rows == 0) return 1;
        if (imm_.likelihood == ModeLikelihood::marginal)
            return density(nu.tail(rows), S.bottomRightCorner(rows, rows));
        return density(nu, S) /
               density(nu.head(landmark_rows), S.topLeftCorner(landmark_rows, landmark_rows));
    }

    void augment(Gaussian& g, int size, const RangeBearingDetection& detection, double velocity_std,
                 double acceleration_std) const {
        Vector2 z = detection.z();
        Matrix2 R = detection.covariance;
        if (invariant_) {
            R(0, 0) += 0.5 * std::pow(z(0) * R(1, 1), 2);
            z(0) *= 1 - 0.5 * R(1, 1);
        }
        Eigen::Matrix<double, 5, 1> y;
        y << g.x.head<3>(), z;
        const auto inverse = [](const auto& v) {
            using S = std::decay_t<decltype(v(0))>;
            return inverseRangeBearing<S>(Eigen::Matrix<S, 3, 1>(v.template head<3>()),
                                          Eigen::Matrix<S, 2, 1>(v.template tail<2>()), Pose2{});
        };
        const Eigen::Matrix<double, 2, 5> G = jacobian<5>(inverse, y);
        const auto n = g.x.size();
        Eigen::MatrixXd A = Eigen::MatrixXd::Zero(n + size, n);
        A.topRows(n).setIdentity();
        A.block<2, 3>(n, 0) = G.leftCols<3>();
        g.P = A * g.P * A.transpose();
        g.P.block<2, 2>(n, n) += G.rightCols<2>() * R * G.rightCols<2>().transpose();
        if (size == 6) {
            g.P.diagonal().segment<2>(n + 2).setConstant(velocity_std * velocity_std);
            g.P.diagonal().segment<2>(n + 4).setConstant(acceleration_std * acceleration_std);
        }
        g.x.conservativeResizeLike(Eigen::VectorXd::Zero(n + size));
        g.x.segment<2>(n) = inverse(y);
    }

    ImmParameters imm_;
    bool invariant_;
    std::vector<Object> objects_;
    std::map<Combination, std::pair<double, Gaussian>> modes_;
};

}  // namespace slamot::test
