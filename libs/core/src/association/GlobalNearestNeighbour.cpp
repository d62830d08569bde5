#include "slamot/core/association/GlobalNearestNeighbour.h"

#include <algorithm>

#include "slamot/core/association/Assignment.h"

namespace slamot {

Pairing globalNearestNeighbour(const AssociationProblem& problem, const DetectionModel& model) {
    const std::vector<double> ratios = logPairRatios(problem, model);
    Pairing pairing(problem.detections());
    for (const Cluster& cluster : clusters(problem)) {
        const auto rows = static_cast<Eigen::Index>(cluster.detections.size()),
                   objects = static_cast<Eigen::Index>(cluster.objects.size());
        // A column of its own lets each detection stay alone at the price 0.
        Eigen::MatrixXd cost = Eigen::MatrixXd::Constant(rows, objects + rows, forbidden_pair);
        Eigen::MatrixXi candidate = Eigen::MatrixXi::Constant(rows, objects + rows, -1);
        for (Eigen::Index row = 0; row < rows; ++row) {
            const int detection = cluster.detections[static_cast<std::size_t>(row)];
            cost(row, objects + row) = 0;
            for (int c = problem.first(detection); c < problem.first(detection + 1); ++c) {
                const auto column = std::lower_bound(cluster.objects.begin(), cluster.objects.end(),
                                                     problem.candidate(c).object) -
                                    cluster.objects.begin();
                cost(row, column) = -ratios[static_cast<std::size_t>(c)];
                candidate(row, column) = c;
            }
        }
        const Assignment assignment = optimalAssignment(cost);
        for (Eigen::Index row = 0; row < rows; ++row) {
            const int c = candidate(row, assignment.column_of_row[static_cast<std::size_t>(row)]);
            if (c >= 0) pairing.add(problem, c);
        }
    }
    return pairing;
}

}  // namespace slamot
