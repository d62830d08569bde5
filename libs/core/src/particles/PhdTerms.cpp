#include "slamot/core/particles/PhdTerms.h"

#include <algorithm>
#include <cmath>

#include "slamot/core/particles/MixedEstimate.h"

namespace slamot {
namespace {

/// d^t P^-1 d <= within, without dividing.
bool isWithin(const Vector2& d, const Matrix2& P, double within) {
    const double det = P(0, 0) * P(1, 1) - P(0, 1) * P(1, 0);
    return P(1, 1) * d.x() * d.x() - 2 * P(0, 1) * d.x() * d.y() + P(0, 0) * d.y() * d.y() <= within * det;
}

GaussianPoint momentsOf(const std::vector<PhdTerm>& terms, const int* first, const int* last) {
    FeatureMixture mixture;
    for (; first != last; ++first) {
        const PhdTerm& term = terms[static_cast<std::size_t>(*first)];
        mixture.add(term.weight, term.point);
    }
    return mixture.moments();
}

}  // namespace

void mergeTerms(const std::vector<PhdTerm>& terms, double least_weight, double within, PhdGroups& out) {
    const auto term = [&](int i) -> const PhdTerm& { return terms[static_cast<std::size_t>(i)]; };
    out.order.clear();
    for (int i = 0; i < static_cast<int>(terms.size()); ++i)
        if (term(i).weight >= least_weight) out.order.push_back(i);
    std::sort(out.order.begin(), out.order.end(), [&](int a, int b) {
        return term(a).weight != term(b).weight ? term(a).weight > term(b).weight : a < b;
    });

    // What joins a group is moved up behind the group's heaviest; the rest keeps its order.
    out.groups.clear();
    const int count = static_cast<int>(out.order.size());
    for (int first = 0; first < count;) {
        const PhdTerm& heaviest = term(out.order[static_cast<std::size_t>(first)]);
        PhdGroup group{first, first + 1, heaviest.weight, heaviest.sight >= 0 ? heaviest.weight : 0,
                       heaviest.point};
        out.left.clear();
        for (int k = first + 1; k < count; ++k) {
            const int i = out.order[static_cast<std::size_t>(k)];
            const PhdTerm& other = term(i);
            if (!isWithin(other.point.mean - heaviest.point.mean, other.point.covariance, within)) {
                out.left.push_back(i);
                continue;
            }
            out.order[static_cast<std::size_t>(group.last++)] = i;
            group.weight += other.weight;
            if (other.sight >= 0) group.detected += other.weight;
        }
        if (group.last > first + 1) {
            std::copy(out.left.begin(), out.left.end(), out.order.begin() + group.last);
            group.point = momentsOf(terms, out.order.data() + first, out.order.data() + group.last);
        }
        out.groups.push_back(group);
        first = group.last;
    }
}

double densityAt(const Vector2& at, const GaussianPoint& point) {
    const Matrix2& P = point.covariance;
    const double det = P(0, 0) * P(1, 1) - P(0, 1) * P(1, 0);
    const Vector2 d = at - point.mean;
    const double squared =
        (P(1, 1) * d.x() * d.x() - 2 * P(0, 1) * d.x() * d.y() + P(0, 0) * d.y() * d.y()) / det;
    return std::exp(-0.5 * squared) / (2 * pi * std::sqrt(det));
}

}  // namespace slamot
