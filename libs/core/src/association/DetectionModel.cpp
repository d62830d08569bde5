#include "slamot/core/association/DetectionModel.h"

#include <cmath>
#include <stdexcept>
#include <string>

namespace slamot {
namespace {

void check(const AssociationProblem& problem, const DetectionModel& model) {
    if (model.detection_probability.size() != static_cast<std::size_t>(problem.objects()) ||
        model.clutter_density.size() != static_cast<std::size_t>(problem.detections()))
        throw std::invalid_argument("DetectionModel: " + std::to_string(model.detection_probability.size()) +
                                    " detection probabilities and " +
                                    std::to_string(model.clutter_density.size()) +
                                    " clutter densities, expected " + std::to_string(problem.objects()) +
                                    " and " + std::to_string(problem.detections()));
    for (const double p : model.detection_probability)
        if (!(p >= 0 && p * model.gate_probability < 1))
            throw std::invalid_argument("DetectionModel: detection probability " + std::to_string(p) +
                                        ", expected at least 0, and below 1 times the gate's probability");
    for (const double c : model.clutter_density)
        if (!(c > 0 && std::isfinite(c)))
            throw std::invalid_argument("DetectionModel: clutter density " + std::to_string(c) +
                                        ", expected a positive number");
}

}  // namespace

double clutterDensity(double per_scan, const RangeBearingSensor& sensor) {
    const double area = (sensor.max_range - sensor.min_range) * sensor.field_of_view;
    if (!(area > 0))
        throw std::invalid_argument("clutterDensity: sensor '" + sensor.label +
                                    "' has no known field of view, expected max_range above min_range");
    return per_scan / area;
}

std::vector<double> logPairRatios(const AssociationProblem& problem, const DetectionModel& model) {
    check(problem, model);
    std::vector<double> out(static_cast<std::size_t>(problem.candidates()));
    for (int c = 0; c < problem.candidates(); ++c) {
        const Candidate& pair = problem.candidate(c);
        const double p = model.detection_probability[static_cast<std::size_t>(pair.object)];
        out[static_cast<std::size_t>(c)] =
            std::log(p) + pair.log_likelihood -
            std::log(model.clutter_density[static_cast<std::size_t>(pair.detection)]) -
            std::log1p(-p * model.gate_probability);
    }
    return out;
}

}  // namespace slamot
