#pragma once
// What several sections show over the time of a run.
#include <string>
#include <vector>

#include "TrackStyles.h"
#include "slamot/report/Figure.h"
#include "slamot/report/RunFolder.h"

namespace slamot::report {

constexpr std::size_t most_objects_shown = 6;

/// An error with its standard deviation; NaN is a gap, a sigma of zero throughout means that it is not known.
struct ErrorCourse {
    std::vector<double> seconds, error, sigma;
    void add(double t, double e, double s);
    bool empty() const { return seconds.empty(); }
};

/// What is longer than this is a gap: five times the median interval.
double longestInterval(const std::vector<double>& intervals);

/// Puts NaN where two entries are more than five times as far apart as they usually are: lines must not
/// bridge gaps.
void breakAtGaps(ErrorCourse& course);

/// "Error in x" with a band of three standard deviations.
Panel errorPanel(const RunFolder& run, const std::string& label, const std::string& unit,
                 const ErrorCourse& course, const std::string& colour);

/// Part of the values that lie within three standard deviations, in percent.
double partWithinThreeSigma(const ErrorCourse& course);

/// From the start of the run to its end, so that all time courses of a page have one axis.
Axis runTimeAxis(const RunFolder& run);

/// The run cut into `count` windows of equal length.
class Windows {
  public:
    Windows(const RunFolder& run, std::size_t count);
    std::size_t of(Stamp stamp) const;
    std::size_t at(double seconds) const;
    std::size_t count() const { return count_; }
    double begin(std::size_t window) const { return length_ * static_cast<double>(window); }
    double middle(std::size_t window) const { return length_ * (static_cast<double>(window) + 0.5); }

  private:
    const RunFolder& run_;
    std::size_t count_;
    double length_;
};

/// At most `most` windows; fewer where they would hold less than `each` of `count` values on average.
Windows windowsFor(const RunFolder& run, std::size_t count, std::size_t most, std::size_t each);

/// A quantile by linear interpolation; sorts a copy. NaN of nothing.
double quantile(std::vector<double> values, double part);

/// The areas between the sums of one row and the next, windows as steps; `rows[k][w]` is the height of layer
/// k.
std::vector<Band> stackedSteps(const Windows& windows, const std::vector<std::vector<double>>& rows,
                               const std::vector<std::string>& labels,
                               const std::vector<std::string>& colours);

/// The true target of a track, by its source id.
std::optional<TrueTarget> truthOf(const RunFolder& run, SourceId source, Stamp stamp);

}  // namespace slamot::report
