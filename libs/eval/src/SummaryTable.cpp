#include <fmt/format.h>

#include <cmath>
#include <sstream>

#include "slamot/core/data/Angle.h"
#include "slamot/eval/Metrics.h"
#include "slamot/eval/TerminalText.h"

namespace slamot::eval {
namespace {

constexpr std::size_t cell_width = 8;

/// One block of the table: a head and rows of a name and right-aligned cells, 32 + 5 x 9 columns at most.
class Block {
  public:
    Block(std::string title, std::vector<std::string> heads)
        : title_(std::move(title)), heads_(std::move(heads)) {}
    void row(const std::string& name, const std::vector<std::string>& cells) { rows_ += line(name, cells); }
    /// Empty when there are no rows.
    std::string text() const { return rows_.empty() ? "" : "\n" + line(title_, heads_) + rows_; }

  private:
    static std::string line(const std::string& name, const std::vector<std::string>& cells) {
        std::string text = fmt::format("{:<32.32}", name);
        for (const std::string& cell : cells) text += fmt::format(" {:>{}}", cell, cell_width);
        return text + "\n";
    }
    std::string title_;
    std::vector<std::string> heads_;
    std::string rows_;
};

/// Four digits, or as many as a cell has room for.
std::string cell(double value) {
    if (std::isnan(value)) return "-";
    std::string text;
    for (int digits = 4; digits > 0; --digits)
        if (text = fmt::format("{:.{}g}", value, digits); text.size() <= cell_width) break;
    return text;
}
std::string percent(double part) {
    return std::isnan(part) ? "-" : fmt::format("{:.1f} %", 100 * part);
}

void errorRow(Block& block, const std::string& name, const ErrorSummary& e, double unit = 1) {
    if (e.count == 0) return;
    block.row(name, {cell(e.rmse * unit), cell(e.median * unit), cell(e.maximum * unit), cell(e.final * unit),
                     fmt::format("{}", e.count)});
}

Block errorBlock(const Metrics& m) {
    constexpr double to_degrees = 180 / pi;
    Block block("Errors", {"RMSE", "median", "maximum", "final", "count"});
    if (m.robot) {
        errorRow(block, "robot position [m]", m.robot->position);
        errorRow(block, "robot heading [deg]", m.robot->heading, to_degrees);
    }
    if (m.ate)
        errorRow(block, fmt::format("ATE, aligned: {} [m]", toText(m.ate->alignment)), m.ate->position);
    if (m.rpe) {
        const std::string over = fmt::format("RPE over {:.4g} {}", m.rpe->delta, toText(m.rpe->unit));
        errorRow(block, over + " [m]", m.rpe->position);
        errorRow(block, over + " [deg]", m.rpe->heading, to_degrees);
    }
    if (m.landmarks) errorRow(block, "landmarks [m]", m.landmarks->position);
    if (m.targets) {
        errorRow(block, "targets [m]", m.targets->all.position);
        errorRow(block, "targets' velocity [m/s]", m.targets->all.velocity);
        errorRow(block, "targets from the robot [m]", m.targets->all.relative_position);
        if (m.targets->seen) {
            errorRow(block, "targets, while seen [m]", m.targets->seen->position);
            errorRow(block, "  from the robot [m]", m.targets->seen->relative_position);
        }
    }
    return block;
}

void neesRow(Block& block, const std::string& name, const Measured<NeesSummary>& n) {
    if (n)
        block.row(name, {cell(n->average), cell(n->mean_dimension), cell(n->median), percent(n->inside),
                         percent(n->coverage)});
}

Block consistencyBlock(const Metrics& m) {
    Block block("Consistency (NEES)", {"mean", "expected", "median", "in band", "coverage"});
    neesRow(block, "robot", m.robot_nees);
    if (m.landmarks) neesRow(block, "landmarks", m.landmarks->nees);
    if (m.targets) {
        neesRow(block, "targets", m.targets->all.nees);
        if (m.targets->seen) neesRow(block, "targets, while seen", m.targets->seen->nees);
    }
    return block;
}

std::int64_t countOf(const NisGroup& group, Outcome outcome) {
    const auto found = group.outcomes.find(outcome);
    return found == group.outcomes.end() ? 0 : found->second;
}

Block innovationBlock(const Metrics& m) {
    Block block("Innovations (NIS per dof)", {"mean", "median", "in band", "used", "rejected"});
    if (m.nis)
        for (const NisGroup& g : *m.nis)
            block.row(fmt::format("{:.20}: {}", g.sensor, slamot::toText(g.kind)),
                      {cell(g.mean_per_degree), cell(g.median_per_degree), percent(g.inside),
                       fmt::format("{}", countOf(g, Outcome::updated) + countOf(g, Outcome::inflated)),
                       fmt::format("{}", countOf(g, Outcome::rejected))});
    return block;
}

void setRow(Block& block, const std::string& name, const SetDistance& d) {
    block.row(name, {cell(d.ospa.total), cell(d.gospa.total), cell(d.gospa.matched_count),
                     cell(d.gospa.missed_count), cell(d.gospa.false_count)});
}

Block setBlock(const Metrics& m) {
    Block block(fmt::format("Sets, p {:.4g}, c {:.4g} m", m.options.set_order, m.options.set_cutoff),
                {"OSPA", "GOSPA", "matched", "missed", "false"});
    if (m.landmark_set) setRow(block, "landmarks, at the end", *m.landmark_set);
    if (m.track_set) setRow(block, "targets, mean over stamps", m.track_set->mean);
    return block;
}

Block associationBlock(const Metrics& m) {
    Block block("Data association", {"recall", "precis.", "detect.", "assoc.", "clutter"});
    if (!m.association) return block;
    const auto row = [&block](const std::string& name, const AssociationScores& s) {
        if (s.detections + s.associated > 0)
            block.row(name, {percent(s.recall), percent(s.precision), fmt::format("{}", s.detections),
                             fmt::format("{}", s.associated), fmt::format("{}", s.clutter)});
    };
    row("landmarks", m.association->landmarks);
    row("movers", m.association->movers);
    return block;
}

/// Both sets of targets under one head.
template <class Cells>
Block trackingBlock(const Metrics& m, const std::string& title, const std::vector<std::string>& heads,
                    Cells cells) {
    Block block(title, heads);
    if (m.tracking) block.row("all targets", cells(*m.tracking));
    if (m.tracking_seen) block.row("targets while seen", cells(*m.tracking_seen));
    return block;
}

Block clearBlock(const Metrics& m) {
    return trackingBlock(m, fmt::format("Tracking, gate {:.4g} m", m.options.target_gate),
                         {"MOTA", "MOTP", "misses", "false", "switches"}, [](const TrackingMetrics& t) {
                             const ClearMot& c = t.clear;
                             return std::vector<std::string>{
                                 percent(c.mota), cell(c.motp), fmt::format("{}", c.misses),
                                 fmt::format("{}", c.false_positives), fmt::format("{}", c.switches)};
                         });
}

Block identityBlock(const Metrics& m) {
    return trackingBlock(m, "Identities", {"IDF1", "IDP", "IDR", "fragm.", "tr./lost"},
                         [](const TrackingMetrics& t) {
                             return std::vector<std::string>{
                                 percent(t.identity.idf1), percent(t.identity.precision),
                                 percent(t.identity.recall), fmt::format("{}", t.clear.fragmentations),
                                 fmt::format("{}/{}", t.clear.mostly_tracked, t.clear.mostly_lost)};
                         });
}

Block trajectoryBlock(const Metrics& m) {
    return trackingBlock(m, fmt::format("T-GOSPA, gamma {:.3g} m; cardinality", m.options.switch_penalty),
                         {"a stamp", "switches", "bound", "error", "abs.err"}, [](const TrackingMetrics& t) {
                             const TrajectoryDistance& d = t.trajectories;
                             return std::vector<std::string>{
                                 cell(d.per_stamp), cell(d.switches),
                                 d.total == d.lower_bound ? "exact" : percent(d.lower_bound / d.total),
                                 cell(t.cardinality.mean), cell(t.cardinality.mean_absolute)};
                         });
}

/// What there is no metric of, equal reasons said once.
std::string absences(const Metrics& m) {
    std::vector<std::pair<std::string, std::string>> reasons;
    const auto add = [&reasons](const std::string& name, const auto& metric) {
        if (metric) return;
        for (auto& [names, reason] : reasons)
            if (reason == metric.whyAbsent()) {
                names += ", " + name;
                return;
            }
        reasons.emplace_back(name, metric.whyAbsent());
    };
    add("robot errors", m.robot);
    add("ATE", m.ate);
    add("RPE", m.rpe);
    add("robot NEES", m.robot_nees);
    add("NIS", m.nis);
    add("landmark errors", m.landmarks);
    if (m.landmarks) add("landmark NEES", m.landmarks->nees);
    add("landmark OSPA and GOSPA", m.landmark_set);
    add("target errors", m.targets);
    if (m.targets) add("target NEES", m.targets->all.nees);
    if (m.targets) add("target errors while seen", m.targets->seen);
    add("target OSPA and GOSPA", m.track_set);
    add("association recall and precision", m.association);
    add("tracking metrics", m.tracking);
    add("tracking metrics of targets while seen", m.tracking_seen);
    add("map cardinality", m.map_cardinality);
    if (m.map_cardinality) add("map cardinality against landmarks seen", m.map_cardinality->seen);
    std::string text;
    for (const auto& [names, reason] : reasons) text += wrapped(fmt::format("No {}: {}.", names, reason));
    return text.empty() ? "" : "\n" + text;
}

}  // namespace

std::string summaryTable(const Metrics& m) {
    std::string text =
        wrapped(fmt::format("Robot: {} of the {} estimates within truth's span matched; {} in all.",
                            m.matching.matched, m.matching.covered, m.matching.total));
    if (m.landmarks)
        text +=
            wrapped(fmt::format("Landmarks: {} matched by {}, {} missing, {} extra.", m.landmarks->matched,
                                m.landmarks->matching == Matching::source_id
                                    ? std::string("source id")
                                    : fmt::format("assignment within {:.4g} m", m.options.landmark_cutoff),
                                m.landmarks->missing, m.landmarks->extra));
    if (m.targets)
        text +=
            wrapped(fmt::format("Targets, over all stamps: {} matched, {} missed, {} tracks without a truth, "
                                "{} without a source id, "
                                "{} doubled.",
                                m.targets->matched, m.targets->missed, m.targets->without_truth,
                                m.targets->without_source, m.targets->doubled));
    if (m.map_cardinality)
        text += wrapped(fmt::format(
            "Landmarks in the map: {}, {:+} against all{}.", m.map_cardinality->estimated,
            m.map_cardinality->error,
            m.map_cardinality->seen ? fmt::format(", {:+} against those seen", m.map_cardinality->seen->error)
                                    : std::string()));
    for (const Block& block : {errorBlock(m), consistencyBlock(m), innovationBlock(m), setBlock(m),
                               associationBlock(m), clearBlock(m), identityBlock(m), trajectoryBlock(m)})
        text += block.text();
    return text + absences(m);
}

}  // namespace slamot::eval
