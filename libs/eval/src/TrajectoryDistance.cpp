#include "slamot/eval/TrajectoryDistance.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include "Courses.h"

namespace slamot::eval {
namespace {

/// The sum over the best courses of groups that need no longer be told apart.
struct Settled {
    double saved = 0;
    std::int64_t pairs = 0, half_switches = 0;
    void add(const Course& course) {
        saved += course.saved;
        pairs += course.pairs;
        half_switches += course.half_switches;
    }
};

/// All groups, found by their objects.
class Groups {
  public:
    explicit Groups(int objects) : group_of_(static_cast<std::size_t>(objects)) {
        for (int i = 0; i < objects; ++i) {
            groups_.push_back(loneGroup(i));
            group_of_[static_cast<std::size_t>(i)] = static_cast<std::size_t>(i);
        }
    }

    /// Joins the groups of two objects. Returns what prune() may have missed.
    double join(int a, int b, double half_switch, std::size_t most) {
        const std::size_t to = of(a), from = of(b);
        if (to == from) return 0;
        groups_[to] = joined(groups_[to], groups_[from]);
        for (const int object : groups_[from].objects) group_of_[static_cast<std::size_t>(object)] = to;
        drop(from);
        return prune(groups_[to], half_switch, most);
    }

    /// The group's value is settled; its objects go on by themselves.
    void separate(std::size_t index) {
        std::vector<CourseGroup> parts = separated(groups_[index]);
        drop(index);
        for (CourseGroup& part : parts) {
            const std::size_t place = freePlace();
            for (const int object : part.objects) group_of_[static_cast<std::size_t>(object)] = place;
            groups_[place] = std::move(part);
        }
    }

    std::size_t of(int object) const { return group_of_[static_cast<std::size_t>(object)]; }
    CourseGroup& at(std::size_t index) { return groups_[index]; }
    const std::vector<CourseGroup>& all() const { return groups_; }

  private:
    void drop(std::size_t index) {
        groups_[index] = {};
        vacant_.push_back(index);
    }
    std::size_t freePlace() {
        if (vacant_.empty()) {
            groups_.emplace_back();
            return groups_.size() - 1;
        }
        const std::size_t place = vacant_.back();
        vacant_.pop_back();
        return place;
    }

    std::vector<CourseGroup> groups_;
    std::vector<std::size_t> group_of_, vacant_;
};

/// What every pair within the cutoff saves, frame by frame.
std::vector<std::vector<Gain>> gainsOf(const TrackingScene& scene, double p, double c) {
    const double cutoff_power = std::pow(c, p);
    std::vector<std::vector<Gain>> gains(scene.frames.size());
    for (std::size_t k = 0; k < gains.size(); ++k)
        for (const SceneObject& target : scene.frames[k].targets)
            for (const SceneObject& track : scene.frames[k].tracks) {
                const double d = (target.position - track.position).norm();
                if (d < c)
                    gains[k].push_back(
                        {target.index, scene.targets + track.index, cutoff_power - std::pow(d, p)});
            }
    return gains;
}

/// For each frame, the objects that no later one names.
std::vector<std::vector<int>> lastNamed(const std::vector<std::vector<Gain>>& gains, int objects) {
    std::vector<std::vector<int>> result(gains.size());
    std::vector<bool> named(static_cast<std::size_t>(objects), false);
    for (std::size_t k = gains.size(); k-- > 0;)
        for (const Gain& g : gains[k])
            for (const int object : {g.target, g.track})
                if (!named[static_cast<std::size_t>(object)]) {
                    named[static_cast<std::size_t>(object)] = true;
                    result[k].push_back(object);
                }
    return result;
}

}  // namespace

// With nothing assigned, every target and track costs c^p / 2 at each of its stamps. An assigned pair within
// the cutoff saves c^p - d^p; making and giving up an assignment costs gamma^p / 2 each. Both are sums over
// pairs, so objects that are not near one another can be looked at apart: groups are joined when two of their
// objects come within the cutoff and taken apart again when only one course is left.
TrajectoryDistance trajectoryDistance(const TrackingScene& scene, double p, double c, double gamma,
                                      const TrajectorySearch& search) {
    TrajectoryDistance result;
    result.stamps = static_cast<std::int64_t>(scene.frames.size());
    if (scene.frames.empty()) return result;
    const double half_switch = std::pow(gamma, p) / 2, half_cutoff = std::pow(c, p) / 2;
    const std::vector<std::vector<Gain>> gains = gainsOf(scene, p, c);
    const std::vector<std::vector<int>> last_named = lastNamed(gains, scene.targets + scene.tracks);

    Groups groups(scene.targets + scene.tracks);
    Settled settled;
    double missed = 0;
    for (std::size_t k = 0; k < gains.size(); ++k) {
        for (const Gain& g : gains[k])
            missed += groups.join(g.target, g.track, half_switch, search.most_courses);
        std::map<std::size_t, std::vector<Gain>> by_group;
        for (const Gain& g : gains[k]) by_group[groups.of(g.target)].push_back(g);
        std::map<std::size_t, std::vector<int>> retiring;
        for (const int object : last_named[k]) retiring[groups.of(object)].push_back(object);

        for (const auto& [index, of_group] : by_group) {
            CourseGroup& group = groups.at(index);
            missed += advance(group, of_group, half_switch, search);
            if (const auto leaving = retiring.find(index); leaving != retiring.end())
                retire(group, leaving->second);
            missed += prune(group, half_switch, search.most_courses);
            // One object or one pair: nothing to take apart.
            if (group.courses.size() > 1 || group.objects.size() <= 1 ||
                (group.objects.size() == 2 && group.courses.front().partner[0] == 1))
                continue;
            settled.add(group.courses.front());
            groups.separate(index);
        }
    }
    for (const CourseGroup& group : groups.all())
        if (!group.courses.empty())
            settled.add(
                *std::max_element(group.courses.begin(), group.courses.end(),
                                  [](const Course& a, const Course& b) { return a.value < b.value; }));

    double targets = 0, tracks = 0;
    for (const SceneFrame& frame : scene.frames) {
        targets += static_cast<double>(frame.targets.size());
        tracks += static_cast<double>(frame.tracks.size());
    }
    const auto stamps = static_cast<double>(result.stamps), pairs = static_cast<double>(settled.pairs);
    const double localisation = std::max(0.0, 2 * half_cutoff * pairs - settled.saved);
    const double missed_targets = half_cutoff * (targets - pairs),
                 false_tracks = half_cutoff * (tracks - pairs);
    const double switching = half_switch * static_cast<double>(settled.half_switches);
    const double power = localisation + missed_targets + false_tracks + switching;
    result.total = std::pow(power, 1 / p);
    result.per_stamp = std::pow(power / stamps, 1 / p);
    result.localisation_part = localisation / stamps;
    result.missed_part = missed_targets / stamps;
    result.false_part = false_tracks / stamps;
    result.switch_part = switching / stamps;
    result.switches = static_cast<double>(settled.half_switches) / 2;
    result.lower_bound = missed == 0 ? result.total : std::pow(std::max(0.0, power - missed), 1 / p);
    return result;
}

}  // namespace slamot::eval
