#pragma once
// Which detection comes from which object: the question and the answers that all methods share. Methods see
// the gated pairs only, so they cost what candidates there are, whatever the map. doc/maths/association.md.
#include <utility>
#include <vector>

namespace slamot {

/// A detection that an object explains well enough to be considered.
struct Candidate {
    int detection = 0, object = 0;
    double nis = 0;             ///< nu^t S^-1 nu of the pair alone
    double log_likelihood = 0;  ///< log N(nu; 0, S), in the units of the measurement
};

/// All candidates of one batch. Detections and objects are numbers below their counts; the caller knows what
/// they stand for.
class AssociationProblem {
  public:
    /// Candidates ordered by detection, then object, each pair once, and finite; throws std::invalid_argument
    /// otherwise.
    AssociationProblem(int detections, int objects, std::vector<Candidate> candidates);

    int detections() const { return static_cast<int>(first_.size()) - 1; }
    int objects() const { return objects_; }
    int candidates() const { return static_cast<int>(candidates_.size()); }
    const Candidate& candidate(int c) const { return candidates_[static_cast<std::size_t>(c)]; }
    /// Candidates of a detection are [first(d), first(d + 1)).
    int first(int detection) const { return first_[static_cast<std::size_t>(detection)]; }
    int candidatesOf(int detection) const { return first(detection + 1) - first(detection); }

    /// Detections that have candidates, those with the fewest first: what is certain settles what is not.
    /// Ties by the likeliest candidate, then by number. Up to such ties the order of the batch does not
    /// matter.
    std::vector<int> unambiguousFirst() const;

  private:
    int objects_;
    std::vector<Candidate> candidates_;
    std::vector<int> first_;
};

/// One object at most for each detection, one detection at most for each object.
struct Pairing {
    std::vector<int> candidate_of_detection;  ///< -1: none

    explicit Pairing(int detections) : candidate_of_detection(static_cast<std::size_t>(detections), -1) {}
    void add(const AssociationProblem& problem, int candidate) {
        candidate_of_detection[static_cast<std::size_t>(problem.candidate(candidate).detection)] = candidate;
    }
    int of(int detection) const { return candidate_of_detection[static_cast<std::size_t>(detection)]; }
    int pairs() const;
    /// For each detection its object, or -1.
    std::vector<int> objects(const AssociationProblem& problem) const;
};

/// Groups of detections and objects that candidates connect: what happens in one does not touch the others.
struct Cluster {
    std::vector<int> detections, objects;  ///< ascending
};
/// Ordered by their first detection; detections and objects without candidates are in none.
std::vector<Cluster> clusters(const AssociationProblem& problem);

}  // namespace slamot
