#pragma once
// The search behind T-GOSPA: courses of assignments through time, for groups of objects that have met.
#include <cstdint>
#include <vector>

#include "slamot/eval/TrajectoryDistance.h"

namespace slamot::eval {

/// A pair of objects within the cutoff at one stamp and what assigning it saves there: c^p - d^p > 0.
/// Objects are numbered through: targets first, tracks after them.
struct Gain {
    int target, track;
    double saved;
};

/// One way to have assigned a group's objects so far. An assignment lasts until one of its two objects is
/// needed for another: keeping it costs nothing, so it is never dropped before.
struct Course {
    enum Partner : int {
        fresh = -1,  ///< never assigned: any one assignment may count as having held since the first stamp
        free = -2,   ///< assigned once, no longer
        gone = -3    ///< assigned to an object that will not come near any other again
    };
    /// By place in the group's list of objects: the place of its partner, or one of the above.
    std::vector<int> partner;
    /// Saved minus the switches' price [m^p].
    double value = 0;
    /// What it is made of.
    double saved = 0;
    std::int64_t pairs = 0, half_switches = 0;
};

/// Objects that must be looked at together, with the courses that may yet turn out best.
struct CourseGroup {
    std::vector<int> objects;
    std::vector<Course> courses;
};

/// The group of one object that was never assigned.
CourseGroup loneGroup(int object);

/// Every course of one with every course of the other.
CourseGroup joined(const CourseGroup& a, const CourseGroup& b);

/// One stamp: new assignments where they may pay, then what the stamp saves. `half_switch` is the price of an
/// assignment made or given up. Returns by how much the best course may have been missed at most.
double advance(CourseGroup& group, const std::vector<Gain>& gains, double half_switch,
               const TrajectorySearch& search);

/// Takes out objects that no gain will name again.
void retire(CourseGroup& group, const std::vector<int>& objects);

/// Drops courses that another can follow from here on at a price that leaves it no worse, then the least
/// valuable beyond `most`. Returns by how much the best course may have been missed at most.
double prune(CourseGroup& group, double half_switch, std::size_t most);

/// A group of one course as groups of one object or one pair each, their values left at zero.
std::vector<CourseGroup> separated(const CourseGroup& group);

}  // namespace slamot::eval
