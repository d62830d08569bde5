#include "Courses.h"

#include <algorithm>
#include <functional>
#include <iterator>
#include <limits>

#include "slamot/core/association/Assignment.h"

namespace slamot::eval {
namespace {

std::size_t placeOf(const CourseGroup& group, int object) {
    return static_cast<std::size_t>(std::lower_bound(group.objects.begin(), group.objects.end(), object) -
                                    group.objects.begin());
}

/// A gain by the places of its objects in the group.
struct PlacedGain {
    std::size_t target, track;
    double saved;
};

void pay(Course& course, double half_switch) {
    course.value -= half_switch;
    ++course.half_switches;
}

void giveUp(Course& course, std::size_t place, double half_switch) {
    int& partner = course.partner[place];
    if (partner >= 0) course.partner[static_cast<std::size_t>(partner)] = Course::free;
    if (partner >= 0 || partner == Course::gone) pay(course, half_switch);
    partner = Course::free;
}

void assign(Course& course, const PlacedGain& pair, double half_switch) {
    int &target = course.partner[pair.target], &track = course.partner[pair.track];
    if (target == static_cast<int>(pair.track)) return;
    if (!(target == Course::fresh && track == Course::fresh)) {
        giveUp(course, pair.target, half_switch);
        giveUp(course, pair.track, half_switch);
        pay(course, half_switch);
    }
    target = static_cast<int>(pair.track);
    track = static_cast<int>(pair.target);
}

double savedBy(const Course& course, const std::vector<PlacedGain>& gains) {
    double sum = 0;
    for (const PlacedGain& g : gains)
        if (course.partner[g.target] == static_cast<int>(g.track)) sum += g.saved;
    return sum;
}

void collect(Course& course, const std::vector<PlacedGain>& gains) {
    for (const PlacedGain& g : gains)
        if (course.partner[g.target] == static_cast<int>(g.track)) {
            course.value += g.saved;
            course.saved += g.saved;
            ++course.pairs;
        }
}

/// The matching that saves most at this stamp.
std::vector<PlacedGain> bestMatching(const std::vector<PlacedGain>& gains, std::size_t objects) {
    if (gains.size() == 1) return gains;
    const auto n = static_cast<Eigen::Index>(objects);
    Eigen::MatrixXd cost = Eigen::MatrixXd::Zero(n, n);
    std::vector<std::vector<const PlacedGain*>> of(objects);
    for (const PlacedGain& g : gains) {
        cost(static_cast<Eigen::Index>(g.target), static_cast<Eigen::Index>(g.track)) = -g.saved;
        of[g.target].push_back(&g);
    }
    const Assignment assignment = optimalAssignment(cost);
    std::vector<PlacedGain> matching;
    for (std::size_t i = 0; i < objects; ++i)
        for (const PlacedGain* g : of[i])
            if (assignment.column_of_row[i] == static_cast<int>(g->track)) matching.push_back(*g);
    return matching;
}

/// Every matching of the gains, the empty one left out; nothing if there are more than `most`.
std::vector<std::vector<PlacedGain>> allMatchings(const std::vector<PlacedGain>& gains, std::size_t objects,
                                                  std::size_t most) {
    std::vector<std::vector<PlacedGain>> matchings;
    std::vector<PlacedGain> chosen;
    std::vector<bool> taken(objects, false);
    bool too_many = false;
    const std::function<void(std::size_t)> extend = [&](std::size_t from) {
        for (std::size_t i = from; i < gains.size() && !too_many; ++i) {
            const PlacedGain& g = gains[i];
            if (taken[g.target] || taken[g.track]) continue;
            chosen.push_back(g);
            matchings.push_back(chosen);
            too_many = matchings.size() > most;
            taken[g.target] = taken[g.track] = true;
            extend(i + 1);
            taken[g.target] = taken[g.track] = false;
            chosen.pop_back();
        }
    };
    extend(0);
    if (too_many) matchings.clear();
    return matchings;
}

/// At most what it costs `from` to do from here on as `to` may do: pairs given up and made, and objects that
/// `to` may still assign as if since the first stamp.
double priceOfFollowing(const Course& from, const Course& to, double half_switch) {
    int half_switches = 0;
    for (std::size_t i = 0; i < from.partner.size(); ++i) {
        const int a = from.partner[i], b = to.partner[i];
        if (a == b) continue;
        // A pair is named by both its objects: count it at the first.
        half_switches += a > static_cast<int>(i);
        half_switches += b > static_cast<int>(i);
        half_switches += a == Course::gone;
        half_switches += b == Course::fresh;
    }
    return half_switches * half_switch;
}

}  // namespace

CourseGroup loneGroup(int object) {
    Course course;
    course.partner = {Course::fresh};
    return {{object}, {course}};
}

CourseGroup joined(const CourseGroup& a, const CourseGroup& b) {
    CourseGroup result;
    std::merge(a.objects.begin(), a.objects.end(), b.objects.begin(), b.objects.end(),
               std::back_inserter(result.objects));
    const auto places = [&result](const CourseGroup& group) {
        std::vector<std::size_t> list;
        for (const int object : group.objects) list.push_back(placeOf(result, object));
        return list;
    };
    const std::vector<std::size_t> place_a = places(a), place_b = places(b);
    const auto copy = [](const Course& from, const std::vector<std::size_t>& place, Course& to) {
        for (std::size_t i = 0; i < place.size(); ++i) {
            const int partner = from.partner[i];
            to.partner[place[i]] = partner < 0 ? partner : static_cast<int>(place[static_cast<std::size_t>(partner)]);
        }
        to.value += from.value;
        to.saved += from.saved;
        to.pairs += from.pairs;
        to.half_switches += from.half_switches;
    };
    for (const Course& of_a : a.courses)
        for (const Course& of_b : b.courses) {
            Course course;
            course.partner.resize(result.objects.size());
            copy(of_a, place_a, course);
            copy(of_b, place_b, course);
            result.courses.push_back(std::move(course));
        }
    return result;
}

// A course that already saves the most this stamp allows need not change now: whatever it might change to it
// can change to later, at the same price. Of the changes of another course only those that save more at once
// are worth holding.
double advance(CourseGroup& group, const std::vector<Gain>& gains, double half_switch,
               const TrajectorySearch& search) {
    std::vector<PlacedGain> placed;
    for (const Gain& g : gains) placed.push_back({placeOf(group, g.target), placeOf(group, g.track), g.saved});
    const std::vector<PlacedGain> best = bestMatching(placed, group.objects.size());
    double most_saved = 0, all = 0, missed = 0;
    for (const PlacedGain& g : best) most_saved += g.saved;
    for (const PlacedGain& g : placed) all += g.saved;

    std::vector<std::vector<PlacedGain>> matchings;
    bool exhaustive = false;
    std::vector<Course> changed;
    for (const Course& course : group.courses) {
        const double saved = savedBy(course, placed);
        // The solver's own steps (Assignment.h) are far below 1e-12 of the sum.
        if (saved >= most_saved - 1e-12 * all) continue;
        if (matchings.empty()) {
            matchings = allMatchings(placed, group.objects.size(), search.most_matchings);
            exhaustive = !matchings.empty();
            if (!exhaustive) matchings = {best};
        }
        if (!exhaustive) missed = std::max(missed, most_saved - saved);
        for (const auto& matching : matchings) {
            Course other = course;
            for (const PlacedGain& g : matching) assign(other, g, half_switch);
            if (savedBy(other, placed) > saved) changed.push_back(std::move(other));
        }
    }
    group.courses.insert(group.courses.end(), changed.begin(), changed.end());
    for (Course& course : group.courses) collect(course, placed);
    return missed;
}

void retire(CourseGroup& group, const std::vector<int>& objects) {
    std::vector<bool> leaves(group.objects.size(), false);
    for (const int object : objects) leaves[placeOf(group, object)] = true;
    std::vector<int> new_place(group.objects.size(), -1);
    std::vector<int> kept;
    for (std::size_t i = 0; i < group.objects.size(); ++i)
        if (!leaves[i]) {
            new_place[i] = static_cast<int>(kept.size());
            kept.push_back(group.objects[i]);
        }
    for (Course& course : group.courses) {
        std::vector<int> partner(kept.size());
        for (std::size_t i = 0; i < leaves.size(); ++i) {
            if (leaves[i]) continue;
            const int old = course.partner[i];
            partner[static_cast<std::size_t>(new_place[i])] =
                old < 0 ? old
                        : leaves[static_cast<std::size_t>(old)] ? static_cast<int>(Course::gone)
                                                                : new_place[static_cast<std::size_t>(old)];
        }
        course.partner = std::move(partner);
    }
    group.objects = std::move(kept);
}

double prune(CourseGroup& group, double half_switch, std::size_t most) {
    std::vector<Course>& courses = group.courses;
    if (courses.size() == 1) return 0;
    std::stable_sort(courses.begin(), courses.end(),
                     [](const Course& a, const Course& b) { return a.value > b.value; });
    std::vector<Course> kept;
    double missed = 0;
    for (Course& course : courses) {
        double followed = -std::numeric_limits<double>::infinity();
        for (const Course& better : kept) {
            followed = std::max(followed, better.value - priceOfFollowing(better, course, half_switch));
            if (followed >= course.value) break;
        }
        if (followed >= course.value) continue;
        if (kept.size() < most)
            kept.push_back(std::move(course));
        else
            missed = std::max(missed, course.value - followed);
    }
    courses = std::move(kept);
    return missed;
}

std::vector<CourseGroup> separated(const CourseGroup& group) {
    std::vector<CourseGroup> parts;
    const Course& course = group.courses.front();
    for (std::size_t i = 0; i < group.objects.size(); ++i) {
        const int partner = course.partner[i];
        if (partner >= 0 && partner < static_cast<int>(i)) continue;
        CourseGroup part = loneGroup(group.objects[i]);
        part.courses.front().partner = {partner};
        if (partner >= 0) {
            part.objects.push_back(group.objects[static_cast<std::size_t>(partner)]);
            part.courses.front().partner = {1, 0};
        }
        parts.push_back(std::move(part));
    }
    return parts;
}

}  // namespace slamot::eval
