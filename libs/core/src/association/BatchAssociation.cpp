#include "slamot/core/association/BatchAssociation.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <tuple>

#include "slamot/core/association/AssociationMarginals.h"
#include "slamot/core/association/DecidedPairs.h"
#include "slamot/core/association/GatedPairs.h"
#include "slamot/core/association/GlobalNearestNeighbour.h"
#include "slamot/core/association/JointCompatibility.h"
#include "slamot/core/association/LinearInnovations.h"
#include "slamot/core/association/MergedDetection.h"
#include "slamot/core/association/NearestNeighbour.h"
#include "slamot/core/association/SequentialCompatibility.h"
#include "slamot/core/estimation/GatheredView.h"
#include "slamot/core/models/RangeBearing.h"

namespace slamot {
namespace {

/// JPDA: what is likelier than this to come from a mover weighs in; the rest cannot matter.
constexpr double least_weight = 1e-3;
/// ... and with less than this none of them stands for it.
constexpr double least_standing = 0.1;

/// JPDA: what is as uncertain after the detections as before gets this noise, in units of P_y...
constexpr double most_noise = 20;
/// ... or less, where bearings further off than this [rad] would do so: they would come near a half turn.
constexpr double most_bearing = 0.5 * pi;

MergedInnovation mergedWithin(const Matrix2& P_y, const std::vector<WeighedInnovation>& weighed) {
    double noise = most_noise;
    MergedInnovation out = mergedInnovation(P_y, weighed, noise);
    while (std::abs(out.residual.y()) > most_bearing && noise > 0.1)
        out = mergedInnovation(P_y, weighed, noise *= 0.5);
    return out;
}

/// Some candidates of a problem, as a problem of its own.
struct Part {
    AssociationProblem problem;
    std::vector<int> in_whole;  ///< by candidate: its number in the whole
};

/// Those that `chosen` gives, which may differ from the whole's in likelihood and NIS.
Part part(const AssociationProblem& whole, const std::function<bool(int, Candidate&)>& chosen) {
    std::vector<Candidate> candidates;
    std::vector<int> in_whole;
    for (int c = 0; c < whole.candidates(); ++c) {
        Candidate candidate = whole.candidate(c);
        if (!chosen(c, candidate)) continue;
        candidates.push_back(candidate);
        in_whole.push_back(c);
    }
    return {AssociationProblem(whole.detections(), whole.objects(), std::move(candidates)),
            std::move(in_whole)};
}

class PartInnovations : public JointInnovations {
  public:
    PartInnovations(JointInnovations& whole, const std::vector<int>& in_whole)
        : whole_(whole), in_whole_(in_whole) {}
    Vector2 residual(int candidate) const override { return whole_.residual(of(candidate)); }
    Matrix2 covariance(int a, int b) override { return whole_.covariance(of(a), of(b)); }

  private:
    int of(int candidate) const { return in_whole_[static_cast<std::size_t>(candidate)]; }
    JointInnovations& whole_;
    const std::vector<int>& in_whole_;
};

/// A batch in the making. An object is detected once at most by a sensor, so each sensor has its turn.
class Batch {
  public:
    Batch(const AssociationParameters& parameters, const GatheredView& view,
          const std::vector<VisibleObject>& objects, const RangeBearingSet& seen,
          const std::vector<double>& clutter_density, const GatedPairs& wide, double gate)
        : parameters_(parameters),
          objects_(objects),
          seen_(seen),
          wide_(wide),
          innovations_(view, wide.measurements),
          gate_(gate) {
        for (const VisibleObject& object : objects) {
            model_.detection_probability.push_back(object.detection_probability * object.visibility);
            is_landmark_.push_back(object.kind == ObjectKind::landmark);
        }
        for (const RangeBearingDetection& detection : seen.detections) noise_.push_back(detection.covariance);
        model_.clutter_density = clutter_density;
        model_.gate_probability = parameters.gate_probability;
        undecided_.assign(seen.detections.size(), -1);
    }

    void landmarks(int sensor, PairGates& gates, BatchAssociation& out);
    /// Given the landmarks of all sensors.
    void movers(int sensor, BatchAssociation& out);
    void findNew(int sensor, BatchAssociation& out) const;

  private:
    const RangeBearingDetection& detectionOf(const Candidate& c) const {
        return seen_.detections[static_cast<std::size_t>(c.detection)];
    }
    const VisibleObject& objectOf(const Candidate& c) const {
        return objects_[static_cast<std::size_t>(c.object)];
    }
    bool isMover(const Candidate& c) const { return objectOf(c).kind == ObjectKind::mover; }
    Pairing landmarkPairing(const Part& part, JointInnovations& innovations, PairGates& gates) const;
    void accept(const Candidate& candidate, int in_whole, BatchAssociation& out);
    void mergeMovers(const Part& part, InnovationFactor& given, BatchAssociation& out);

    const AssociationParameters& parameters_;
    const std::vector<VisibleObject>& objects_;
    const RangeBearingSet& seen_;
    const GatedPairs& wide_;
    LinearInnovations innovations_;
    DetectionModel model_;
    std::vector<Matrix2> noise_;     ///< by detection
    std::vector<bool> is_landmark_;  ///< by object
    double gate_;
    std::vector<int> landmark_pairs_;  ///< candidates of the whole
    std::vector<int> undecided_;       ///< by detection: the landmark it may be of; -1: none, or decided
};

void Batch::accept(const Candidate& c, int in_whole, BatchAssociation& out) {
    const double density = model_.clutter_density[static_cast<std::size_t>(c.detection)];
    out.of_detection[static_cast<std::size_t>(c.detection)] = {
        c.object, c.nis,
        objectOf(c).detection_probability * std::exp(std::min(c.log_likelihood, 500.0)) / density};
    if (!isMover(c)) landmark_pairs_.push_back(in_whole);
}

void Batch::landmarks(int sensor, PairGates& gates, BatchAssociation& out) {
    if (parameters_.landmarks == LandmarkAssociation::known) return;
    // Where a detection may be of either, movers compete, for it and for those of their own; their pairs are
    // made in their own turn.
    const bool contested = std::any_of(
        seen_.detections.begin(), seen_.detections.end(), [sensor](const RangeBearingDetection& detection) {
            return detection.sensor == sensor && detection.kind == ObjectKind::unknown;
        });
    const Part candidates = part(wide_.problem, [&](int, Candidate& c) {
        return detectionOf(c).sensor == sensor && c.nis <= gate_ && (!isMover(c) || contested);
    });
    PartInnovations innovations(innovations_, candidates.in_whole);
    const Pairing pairing = landmarkPairing(candidates, innovations, gates);
    std::vector<int> pairs;
    for (const int c : pairing.candidate_of_detection)
        if (c >= 0 && !isMover(candidates.problem.candidate(c))) pairs.push_back(c);
    const std::vector<int> sure =
        decidedPairs(candidates.problem, innovations, pairs, {model_, noise_, is_landmark_},
                     parameters_.decide_probability);
    for (const int c : sure)
        accept(candidates.problem.candidate(c), candidates.in_whole[static_cast<std::size_t>(c)], out);
    for (const int c : pairs) {
        if (std::find(sure.begin(), sure.end(), c) != sure.end()) continue;
        const Candidate& pair = candidates.problem.candidate(c);
        undecided_[static_cast<std::size_t>(pair.detection)] = pair.object;
        out.in_doubt[static_cast<std::size_t>(pair.object)] = true;
    }
}

Pairing Batch::landmarkPairing(const Part& candidates, JointInnovations& innovations,
                               PairGates& gates) const {
    switch (parameters_.landmarks) {
        case LandmarkAssociation::nearest:
            return nearestNeighbour(candidates.problem);
        case LandmarkAssociation::sequential:
            return sequentialCompatibility(candidates.problem, innovations, gates);
        case LandmarkAssociation::gnn:
            return globalNearestNeighbour(candidates.problem, model_);
        default:
            return jointCompatibility(candidates.problem, innovations, gates, parameters_.node_budget)
                .pairing;
    }
}

void Batch::movers(int sensor, BatchAssociation& out) {
    if (parameters_.movers == MoverAssociation::known) return;
    InnovationFactor given(innovations_, static_cast<int>(landmark_pairs_.size()) + 1);
    for (const int c : landmark_pairs_) given.push(c);
    const double nis_of_landmarks = given.nis();
    const Part candidates = part(wide_.problem, [&](int in_whole, Candidate& c) {
        if (!isMover(c) || detectionOf(c).sensor != sensor) return false;
        if (out.of_detection[static_cast<std::size_t>(c.detection)].object >= 0) return false;
        if (!given.push(in_whole)) return false;
        c.nis = given.nis() - nis_of_landmarks;
        c.log_likelihood = given.logConditional();
        given.pop();
        return c.nis <= gate_;
    });
    if (parameters_.movers == MoverAssociation::jpda) return mergeMovers(candidates, given, out);
    const Pairing pairing = parameters_.movers == MoverAssociation::nearest
                                ? nearestNeighbour(candidates.problem)
                                : globalNearestNeighbour(candidates.problem, model_);
    for (const int c : pairing.candidate_of_detection)
        if (c >= 0)
            accept(candidates.problem.candidate(c), candidates.in_whole[static_cast<std::size_t>(c)], out);
}

void Batch::mergeMovers(const Part& candidates, InnovationFactor& given, BatchAssociation& out) {
    const AssociationMarginals marginals =
        associationMarginals(candidates.problem, model_, parameters_.state_budget);
    const auto weight = [&](int c) { return marginals.pair[static_cast<std::size_t>(c)]; };
    // A mover's likeliest detection stands for it: the likeliest of all pairs first.
    std::vector<int> order;
    std::vector<std::vector<int>> of_object(objects_.size());
    for (int c = 0; c < candidates.problem.candidates(); ++c) {
        if (weight(c) < least_weight) continue;
        order.push_back(c);
        of_object[static_cast<std::size_t>(candidates.problem.candidate(c).object)].push_back(c);
    }
    std::sort(order.begin(), order.end(),
              [&](int a, int b) { return std::make_tuple(-weight(a), a) < std::make_tuple(-weight(b), b); });
    std::vector<char> taken(objects_.size(), 0);
    for (const int c : order) {
        const Candidate& pair = candidates.problem.candidate(c);
        char& object_taken = taken[static_cast<std::size_t>(pair.object)];
        if (object_taken || out.of_detection[static_cast<std::size_t>(pair.detection)].object >= 0) continue;
        if (weight(c) < least_standing) break;
        object_taken = 1;

        std::vector<WeighedInnovation> weighed;
        Matrix2 P_y = Matrix2::Zero();
        Vector2 expected = Vector2::Zero();
        for (const int other : of_object[static_cast<std::size_t>(pair.object)]) {
            const RangeBearingDetection& seen = detectionOf(candidates.problem.candidate(other));
            given.push(candidates.in_whole[static_cast<std::size_t>(other)]);
            const auto [residual, S] = given.conditional();
            given.pop();
            weighed.push_back({weight(other), residual, seen.covariance});
            P_y = S - seen.covariance;  // with the second-order terms, which the update adds itself
            expected = seen.z() - residual;
        }
        const MergedInnovation merged = mergedWithin(P_y, weighed);
        RangeBearingDetection& detection = out.merged[static_cast<std::size_t>(pair.detection)];
        const Vector2 z = expected + merged.residual;
        detection.range = z.x();
        detection.bearing = wrapAngle(z.y());
        detection.covariance = merged.noise;
        accept(pair, candidates.in_whole[static_cast<std::size_t>(c)], out);
        // All that its gate holds, weighed: (1 - P_D) / P(missed).
        const auto object = static_cast<std::size_t>(pair.object);
        out.of_detection[static_cast<std::size_t>(pair.detection)].likelihood_ratio =
            (1 - model_.detection_probability[object]) / std::max(marginals.missed[object], 1e-12);
    }
    // Its detection stands for another: not missed.
    for (const int c : order) {
        const auto object = static_cast<std::size_t>(candidates.problem.candidate(c).object);
        if (weight(c) >= least_standing && !taken[object]) out.in_doubt[object] = true;
    }
}

void Batch::findNew(int sensor, BatchAssociation& out) const {
    std::vector<char> taken(objects_.size(), 0);
    for (std::size_t d = 0; d < seen_.detections.size(); ++d) {
        const int object = out.of_detection[d].object;
        if (seen_.detections[d].sensor != sensor) continue;
        if (undecided_[d] >= 0) taken[static_cast<std::size_t>(undecided_[d])] = 1;
        if (object < 0) continue;
        taken[static_cast<std::size_t>(object)] = 1;
        out.may_be_new[d] = false;
    }
    for (int c = 0; c < wide_.problem.candidates(); ++c) {
        const Candidate& pair = wide_.problem.candidate(c);
        const auto d = static_cast<std::size_t>(pair.detection);
        if (detectionOf(pair).sensor == sensor && !taken[static_cast<std::size_t>(pair.object)])
            out.may_be_new[d] = false;
    }
}

}  // namespace

ParameterTable describe(AssociationParameters& p, const std::string& name) {
    ParameterTable table(name, "Which object a detection without an identity comes from.");
    table
        .choice("landmarks", p.landmarks,
                {{"jcbb", LandmarkAssociation::jcbb},
                 {"sequential", LandmarkAssociation::sequential},
                 {"nearest", LandmarkAssociation::nearest},
                 {"gnn", LandmarkAssociation::gnn},
                 {"known", LandmarkAssociation::known}},
                "jcbb: the largest jointly compatible set of pairs; sequential: pair by pair, each in the "
                "light of those before; nearest: each pair alone; gnn: the likeliest assignment of all; "
                "known: detections without an identity are ignored.")
        .choice("movers", p.movers,
                {{"gnn", MoverAssociation::gnn},
                 {"jpda", MoverAssociation::jpda},
                 {"nearest", MoverAssociation::nearest},
                 {"known", MoverAssociation::known}},
                "As for landmarks; jpda: each mover is updated with all detections in its gate, weighed by "
                "probability.")
        .real("gate_probability", p.gate_probability, "-", Interval::openProbability(),
              "Part of an object's detections that lie inside its gate.")
        .real("separation_probability", p.separation_probability, "-", Interval::openProbability(),
              "A detection inside this gate of an object that is not seen otherwise starts no new object.")
        .real("decide_probability", p.decide_probability, "-", Interval::openProbability(),
              "Of a pair with a landmark, against another landmark and against something new or false in a "
              "gate "
              "as wide as this one; below it the pair is left undecided: the detection corrects nothing and "
              "may "
              "be of something new, and the landmark does not count as missed.")
        .integer("node_budget", p.node_budget, Interval::between(1, 1000000),
                 "Extensions of hypotheses that jcbb tries at most; beyond, the best met so far is taken, at "
                 "least as good as the sequential one.")
        .integer("state_budget", p.state_budget, Interval::between(1, 1000000),
                 "States of jpda's exact sums at most; beyond, belief propagation approximates them.");
    return table;
}

BatchAssociator::BatchAssociator(const AssociationParameters& parameters, Consistency consistency)
    : parameters_(parameters),
      consistency_(consistency),
      gates_(parameters.gate_probability),
      separation_(std::max(parameters.separation_probability, parameters.gate_probability)) {}

BatchAssociation BatchAssociator::associate(const JointView& state, const std::vector<VisibleObject>& objects,
                                            const RangeBearingSet& seen, const std::vector<int>& detections,
                                            const std::vector<double>& clutter_density) {
    BatchAssociation out;
    out.of_detection.resize(seen.detections.size());
    out.may_be_new.resize(seen.detections.size(), false);
    out.in_doubt.resize(objects.size(), false);
    out.merged = seen.detections;
    out.soft = parameters_.movers == MoverAssociation::jpda;
    for (const int d : detections) {
        const ObjectKind kind = seen.detections[static_cast<std::size_t>(d)].kind;
        const bool landmark = kind != ObjectKind::mover, mover = kind != ObjectKind::landmark;
        out.may_be_new[static_cast<std::size_t>(d)] =
            !(landmark && parameters_.landmarks == LandmarkAssociation::known) &&
            !(mover && parameters_.movers == MoverAssociation::known);
    }

    std::vector<BlockId> blocks;
    for (const VisibleObject& object : objects) blocks.push_back(object.block);
    const GatheredView view(state, blocks);
    const auto may_pair = [&](int d, int o) {
        const ObjectKind kind = seen.detections[static_cast<std::size_t>(d)].kind;
        return kind == ObjectKind::unknown || kind == objects[static_cast<std::size_t>(o)].kind;
    };
    const GatedPairs wide = gatedPairs(view, blocks, seen, detections, consistency_, separation_, may_pair);
    Batch batch(parameters_, view, objects, seen, clutter_density, wide, gates_(1));
    const int sensors = static_cast<int>(seen.sensors.size());
    for (int sensor = 0; sensor < sensors; ++sensor) batch.landmarks(sensor, gates_, out);
    for (int sensor = 0; sensor < sensors; ++sensor) batch.movers(sensor, out);
    for (int sensor = 0; sensor < sensors; ++sensor) batch.findNew(sensor, out);
    return out;
}

}  // namespace slamot
