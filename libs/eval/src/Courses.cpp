#include "Courses.h"

#include <algorithm>
#include <iterator>
#include <limits>
#include <map>

#include "Matchings.h"

namespace slamot::eval {
namespace {

std::size_t placeOf(const CourseGroup& group, int object) {
    return static_cast<std::size_t>(std::lower_bound(group.objects.begin(), group.objects.end(), object) -
                                    group.objects.begin());
}

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

double savedBy(const Course& course, const PairSet& gains) {
    double sum = 0;
    for (const PlacedGain& g : gains)
        if (course.partner[g.target] == static_cast<int>(g.track)) sum += g.saved;
    return sum;
}

void collect(Course& course, const PairSet& gains) {
    for (const PlacedGain& g : gains)
        if (course.partner[g.target] == static_cast<int>(g.track)) {
            course.value += g.saved;
            course.saved += g.saved;
            ++course.pairs;
        }
}

/// The gains in parts that share no object, nor the two objects of a pair the course has assigned: a change
/// in one part touches no other.
std::vector<PairSet> partsOf(const PairSet& gains, const Course& course) {
    std::vector<std::size_t> root(course.partner.size());
    for (std::size_t i = 0; i < root.size(); ++i) root[i] = i;
    const auto find = [&root](std::size_t i) {
        while (root[i] != i) i = root[i];
        return i;
    };
    for (std::size_t i = 0; i < root.size(); ++i)
        if (course.partner[i] >= 0) root[find(i)] = find(static_cast<std::size_t>(course.partner[i]));
    for (const PlacedGain& g : gains) root[find(g.target)] = find(g.track);
    std::map<std::size_t, PairSet> by_root;
    for (const PlacedGain& g : gains) by_root[find(g.target)].push_back(g);
    std::vector<PairSet> parts;
    for (auto& [part, of_part] : by_root) parts.push_back(std::move(of_part));
    return parts;
}

/// What a course may change in one part at one stamp: the matchings that save more there than it does.
struct PartChanges {
    std::vector<PairSet> better;
    PairSet best;
    /// By how much the best may exceed what the course saves, if `better` is not all there is.
    double gap = 0;
    bool exhaustive = true;
};

std::vector<PartChanges> changesOf(const Course& course, const PairSet& gains, std::size_t most_matchings) {
    std::vector<PartChanges> changes;
    for (const auto& part : partsOf(gains, course)) {
        PartChanges of_part;
        of_part.best = bestMatching(part, course.partner.size());
        const double saved = savedBy(course, part), rounding = 1e-12 * sumOf(part);
        of_part.gap = sumOf(of_part.best) - saved;
        // The solver's own steps (Assignment.h) are far below the rounding.
        if (of_part.gap <= rounding) continue;
        std::vector<PairSet> matchings = matchingsWithin(of_part.gap + rounding, part, of_part.best,
                                                         course.partner.size(), most_matchings);
        of_part.exhaustive = !matchings.empty();
        if (!of_part.exhaustive) matchings = {of_part.best};
        for (PairSet& matching : matchings) {
            Course other = course;
            for (const PlacedGain& g : matching) assign(other, g, 0);
            if (savedBy(other, part) > saved) of_part.better.push_back(std::move(matching));
        }
        changes.push_back(std::move(of_part));
    }
    // Every choice in one part goes with every one in another: where that is too many, the best of each.
    double choices = 1;
    for (const PartChanges& of_part : changes) choices *= 1.0 + static_cast<double>(of_part.better.size());
    if (choices > static_cast<double>(most_matchings))
        for (PartChanges& of_part : changes)
            if (of_part.better.size() > 1) {
                of_part.better = {of_part.best};
                of_part.exhaustive = false;
            }
    return changes;
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
            to.partner[place[i]] =
                partner < 0 ? partner : static_cast<int>(place[static_cast<std::size_t>(partner)]);
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
// can change to later, at the same price. Of the changes of another course only those that save more at once,
// in each part they touch, are worth holding.
double advance(CourseGroup& group, const std::vector<Gain>& gains, double half_switch,
               const TrajectorySearch& search) {
    PairSet placed;
    for (const Gain& g : gains)
        placed.push_back({placeOf(group, g.target), placeOf(group, g.track), g.saved});
    const double all = sumOf(placed);

    double missed = 0;
    std::vector<Course> changed;
    for (const Course& course : group.courses) {
        if (savedBy(course, placed) == all) continue;
        std::vector<Course> choices{course};
        double gap = 0;
        for (const PartChanges& of_part : changesOf(course, placed, search.most_matchings)) {
            if (!of_part.exhaustive) gap += of_part.gap;
            for (std::size_t i = 0, before = choices.size(); i < before; ++i)
                for (const PairSet& matching : of_part.better) {
                    Course other = choices[i];
                    for (const PlacedGain& g : matching) assign(other, g, half_switch);
                    choices.push_back(std::move(other));
                }
        }
        missed = std::max(missed, gap);
        changed.insert(changed.end(), choices.begin() + 1, choices.end());
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
            partner[static_cast<std::size_t>(new_place[i])] = old < 0 ? old
                                                              : leaves[static_cast<std::size_t>(old)]
                                                                  ? static_cast<int>(Course::gone)
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
