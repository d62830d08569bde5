#include "slamot/core/association/SequentialCompatibility.h"

namespace slamot {

Pairing sequentialCompatibility(const AssociationProblem& problem, JointInnovations& innovations,
                                PairGates& gates) {
    const std::vector<int> order = problem.unambiguousFirst();
    InnovationFactor chosen(innovations, static_cast<int>(order.size()));
    std::vector<char> taken(static_cast<std::size_t>(problem.objects()), 0);
    Pairing pairing(problem.detections());
    for (const int detection : order) {
        int best = -1;
        double best_log = 0;
        for (int c = problem.first(detection); c < problem.first(detection + 1); ++c) {
            if (taken[static_cast<std::size_t>(problem.candidate(c).object)] || !chosen.push(c)) continue;
            const bool compatible = chosen.nis() <= gates(chosen.pairs());
            const double log_conditional = chosen.logConditional();
            chosen.pop();
            if (!compatible || (best >= 0 && log_conditional <= best_log)) continue;
            best = c;
            best_log = log_conditional;
        }
        if (best < 0) continue;
        chosen.push(best);
        pairing.add(problem, best);
        taken[static_cast<std::size_t>(problem.candidate(best).object)] = 1;
    }
    return pairing;
}

}  // namespace slamot
