#include "slamot/core/association/DecidedPairs.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "slamot/core/association/ChiSquare.h"

namespace slamot {
namespace {

/// Squared distance of two detections of one place: 99.9 % are below.
const double same_place = chiSquareQuantile(0.999, 2);

class Evidence {
  public:
    Evidence(const AssociationProblem& problem, JointInnovations& innovations, const DecisionModel& model,
             int most_pairs)
        : problem_(problem), model_(model), given_(innovations, most_pairs) {}

    /// Log odds of pairs being right, all of them, given those that were added: against clutter and against
    /// what else could be made of their detections.
    double of(const std::vector<int>& pairs);
    /// From here on the pair is given.
    void add(int pair) { given_.push(pair); }

  private:
    /// Makes a pair given; log of how much likelier it is than something false or new in a gate as wide.
    /// Nothing is done where it says nothing new.
    std::optional<double> push(int pair);
    void pop(int pairs) {
        for (; pairs > 0; --pairs) given_.pop();
    }
    const Matrix2& noiseOf(const Candidate& pair) const {
        return model_.noise[static_cast<std::size_t>(pair.detection)];
    }
    bool isGiven(int object) const {
        const std::vector<int>& given = given_.candidates();
        return std::any_of(given.begin(), given.end(),
                           [&](int c) { return problem_.candidate(c).object == object; });
    }
    /// The innovation of a pair; none where it says nothing new.
    std::optional<Vector2> innovation(int pair);
    /// The rivals of a pair: other objects for its detection, elsewhere.
    std::vector<int> rivals(int pair);
    /// The likeliest way to explain the detections of `pairs`, the first one by `first`.
    double likeliest(int first, const std::vector<int>& pairs);

    const AssociationProblem& problem_;
    const DecisionModel& model_;
    InnovationFactor given_;
};

std::optional<double> Evidence::push(int pair) {
    const Candidate& c = problem_.candidate(pair);
    if (isGiven(c.object) || !given_.push(pair)) return std::nullopt;
    const double places = std::sqrt(given_.conditional().covariance.determinant() / noiseOf(c).determinant());
    return std::log(model_.detection.detection_probability[static_cast<std::size_t>(c.object)]) +
           given_.logConditional() -
           std::log(model_.detection.clutter_density[static_cast<std::size_t>(c.detection)] * places);
}

std::optional<Vector2> Evidence::innovation(int pair) {
    if (!push(pair)) return std::nullopt;
    const Vector2 residual = given_.conditional().residual;
    pop(1);
    return residual;
}

std::vector<int> Evidence::rivals(int pair) {
    const Candidate& chosen = problem_.candidate(pair);
    const std::optional<Vector2> here = innovation(pair);
    const Eigen::LLT<Matrix2> R(noiseOf(chosen));
    std::vector<int> out;
    for (int c = problem_.first(chosen.detection); here && c < problem_.first(chosen.detection + 1); ++c) {
        if (c == pair || !model_.may_be_rivals[static_cast<std::size_t>(problem_.candidate(c).object)])
            continue;
        const std::optional<Vector2> there = innovation(c);
        if (there && (*there - *here).dot(R.solve(*there - *here)) > same_place) out.push_back(c);
    }
    return out;
}

double Evidence::likeliest(int first, const std::vector<int>& pairs) {
    double sum = *push(first);
    int pushed = 1;
    for (const int pair : pairs) {
        const int detection = problem_.candidate(pair).detection;
        if (detection == problem_.candidate(first).detection) continue;
        double best = 0;  // clutter
        int with = -1;
        for (int c = problem_.first(detection); c < problem_.first(detection + 1); ++c) {
            const std::optional<double> odds = push(c);
            if (!odds) continue;
            if (*odds > best) {
                best = *odds;
                with = c;
            }
            pop(1);
        }
        if (with < 0) continue;
        sum += *push(with);
        ++pushed;
    }
    pop(pushed);
    return sum;
}

double Evidence::of(const std::vector<int>& pairs) {
    double log_odds = 0;
    int pushed = 0;
    for (const int c : pairs) {
        const std::optional<double> odds = push(c);
        if (!odds) continue;
        log_odds += *odds;
        ++pushed;
    }
    pop(pushed);
    if (pushed == 0) return -std::numeric_limits<double>::infinity();

    double others = std::exp(-log_odds);
    for (const int pair : pairs)
        for (const int rival : rivals(pair)) others += std::exp(likeliest(rival, pairs) - log_odds);
    return -std::log(others);
}

}  // namespace

std::vector<int> decidedPairs(const AssociationProblem& problem, JointInnovations& innovations,
                              const std::vector<int>& pairs, const DecisionModel& model, double probability) {
    const double enough = std::log(probability) - std::log1p(-probability);
    // A rival is pushed beside the pairs that are given.
    Evidence evidence(problem, innovations, model, static_cast<int>(pairs.size()) + 1);
    std::vector<int> open = pairs, decided;
    // One by one, in the light of those that count already ...
    for (bool more = true; more;) {
        more = false;
        std::vector<int> rest;
        for (const int c : open) {
            if (evidence.of({c}) < enough) {
                rest.push_back(c);
                continue;
            }
            evidence.add(c);
            decided.push_back(c);
            more = true;
        }
        open = std::move(rest);
    }
    // ... then the others together: several that fit in one way bear each other out.
    if (open.size() > 1 && evidence.of(open) >= enough)
        decided.insert(decided.end(), open.begin(), open.end());
    return decided;
}

}  // namespace slamot
