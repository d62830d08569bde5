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

/// Of the differences between two detections of one place.
constexpr double same_place_probability = 0.999;

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
    /// Whether `c` is of another object, elsewhere, for the detection of `pair`.
    bool isRival(int c, int pair);
    /// The likeliest way to explain the detections of `pairs`, the first one by `first`.
    double likeliest(int first, const std::vector<int>& pairs);

    const AssociationProblem& problem_;
    const DecisionModel& model_;
    InnovationFactor given_;
    const double same_place_ = chiSquareQuantile(same_place_probability, 2);
};

std::optional<double> Evidence::push(int pair) {
    const Candidate& c = problem_.candidate(pair);
    if (isGiven(c.object) || !given_.push(pair)) return std::nullopt;
    const double places = std::sqrt(given_.conditional().covariance.determinant() / noiseOf(c).determinant());
    return std::log(model_.detection.detection_probability[static_cast<std::size_t>(c.object)]) +
           given_.logConditional() -
           std::log(model_.detection.clutter_density[static_cast<std::size_t>(c.detection)] * places);
}

bool Evidence::isRival(int c, int pair) {
    const Candidate& rival = problem_.candidate(c);
    if (c == pair || !model_.may_be_rivals[static_cast<std::size_t>(rival.object)]) return false;
    if (!push(pair)) return false;
    Vector2 apart = given_.conditional().residual;
    pop(1);
    if (!push(c)) return false;
    apart -= given_.conditional().residual;
    pop(1);
    return apart.dot(noiseOf(rival).llt().solve(apart)) > same_place_;
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
    for (const int pair : pairs) {
        const int detection = problem_.candidate(pair).detection;
        for (int c = problem_.first(detection); c < problem_.first(detection + 1); ++c)
            if (isRival(c, pair)) others += std::exp(likeliest(c, pairs) - log_odds);
    }
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
