#pragma once
// Small association problems, and all of their pairings one by one.
#include <Eigen/LU>
#include <cmath>
#include <vector>

#include "slamot/core/association/AssociationProblem.h"
#include "slamot/core/association/DetectionModel.h"
#include "slamot/core/association/JointInnovations.h"
#include "support/RandomMatrices.h"

namespace slamot::test {

/// Residuals and covariance of all candidates as one vector and one matrix.
struct MatrixInnovations : JointInnovations {
    Eigen::VectorXd nu;
    Eigen::MatrixXd S;

    Vector2 residual(int candidate) const override { return nu.segment<2>(2 * candidate); }
    Matrix2 covariance(int a, int b) override { return S.block<2, 2>(2 * a, 2 * b); }

    /// nu^t S^-1 nu of some candidates, by elimination of the whole.
    double nis(const std::vector<int>& candidates) const {
        if (candidates.empty()) return 0;
        const auto n = static_cast<Eigen::Index>(candidates.size());
        Eigen::VectorXd part(2 * n);
        Eigen::MatrixXd P(2 * n, 2 * n);
        for (Eigen::Index i = 0; i < n; ++i) {
            const int a = candidates[static_cast<std::size_t>(i)];
            part.segment<2>(2 * i) = nu.segment<2>(2 * a);
            for (Eigen::Index j = 0; j < n; ++j)
                P.block<2, 2>(2 * i, 2 * j) =
                    S.block<2, 2>(2 * a, 2 * candidates[static_cast<std::size_t>(j)]);
        }
        return part.dot(P.fullPivLu().solve(part));
    }
};

/// Each pair of detection and object is a candidate with that probability; likelihoods are drawn.
inline AssociationProblem randomProblem(RandomStream& random, int detections, int objects, double part) {
    std::vector<Candidate> candidates;
    for (int d = 0; d < detections; ++d)
        for (int o = 0; o < objects; ++o)
            if (random.uniform() < part)
                candidates.push_back({d, o, random.uniform(0, 9), random.uniform(-6, 2)});
    return {detections, objects, candidates};
}

/// Objects that an uncertain robot sees: innovations share its error. Residuals are of the size that S says.
inline MatrixInnovations randomInnovations(RandomStream& random, int candidates, double common) {
    MatrixInnovations out;
    const Eigen::MatrixXd H = randomMatrix(random, 2 * candidates, 3);
    out.S = common * H * H.transpose() + 0.3 * Eigen::MatrixXd::Identity(2 * candidates, 2 * candidates);
    out.nu = std::sqrt(common) * H * randomVector(random, 3) + 0.9 * randomVector(random, 2 * candidates);
    return out;
}

inline DetectionModel randomModel(RandomStream& random, const AssociationProblem& problem) {
    DetectionModel model;
    for (int o = 0; o < problem.objects(); ++o)
        model.detection_probability.push_back(random.uniform(0.3, 0.98));
    for (int d = 0; d < problem.detections(); ++d) model.clutter_density.push_back(random.uniform(0.01, 0.5));
    model.gate_probability = 0.99;
    return model;
}

/// Calls `visit` with the candidates (in the order of `detections`) of every pairing there is.
template <class Visit>
void forEachPairing(const AssociationProblem& problem, const std::vector<int>& detections,
                    const Visit& visit) {
    std::vector<int> chosen;
    const auto decide = [&](const auto& self, std::size_t place) -> void {
        if (place == detections.size()) return visit(chosen);
        self(self, place + 1);
        for (int c = problem.first(detections[place]); c < problem.first(detections[place] + 1); ++c) {
            bool free = true;
            for (const int other : chosen)
                free = free && problem.candidate(other).object != problem.candidate(c).object;
            if (!free) continue;
            chosen.push_back(c);
            self(self, place + 1);
            chosen.pop_back();
        }
    };
    decide(decide, 0);
}

inline std::vector<int> allDetections(const AssociationProblem& problem) {
    std::vector<int> out;
    for (int d = 0; d < problem.detections(); ++d) out.push_back(d);
    return out;
}

}  // namespace slamot::test
