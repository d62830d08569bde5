#include "slamot/core/association/NearestNeighbour.h"

#include <algorithm>
#include <tuple>

namespace slamot {

Pairing nearestNeighbour(const AssociationProblem& problem) {
    std::vector<int> order(static_cast<std::size_t>(problem.candidates()));
    for (std::size_t c = 0; c < order.size(); ++c) order[c] = static_cast<int>(c);
    std::sort(order.begin(), order.end(), [&problem](int a, int b) {
        const Candidate &p = problem.candidate(a), &q = problem.candidate(b);
        return std::make_tuple(-p.log_likelihood, p.nis, a) < std::make_tuple(-q.log_likelihood, q.nis, b);
    });

    Pairing pairing(problem.detections());
    std::vector<char> taken(static_cast<std::size_t>(problem.objects()), 0);
    for (const int c : order) {
        char& object_taken = taken[static_cast<std::size_t>(problem.candidate(c).object)];
        if (object_taken || pairing.of(problem.candidate(c).detection) >= 0) continue;
        pairing.add(problem, c);
        object_taken = 1;
    }
    return pairing;
}

}  // namespace slamot
