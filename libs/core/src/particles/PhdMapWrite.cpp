// What the groups of an update become in the pages of the map.
#include <utility>

#include "slamot/core/particles/MixedEstimate.h"
#include "slamot/core/particles/PhdMap.h"

namespace slamot {
namespace {

/// The component of the heaviest member whose place is still free, which is taken now; null: there is none.
PhdMap::Seen* holderOf(const PhdGroup& group, PhdMap::Work& work) {
    for (int k = group.first; k < group.last; ++k) {
        PhdMap::Seen& seen = work.seenOf(work.member(k));
        if (!std::exchange(seen.kept, true)) return &seen;
    }
    return nullptr;
}

/// A sight of the view whose number is still free, which is given away now: one that has a part in the group,
/// else one that may be of the component its heaviest member came from. Null: there is none.
const PhdSight* numberFor(const PhdGroup& group, int view, PhdMap::Work& work) {
    const auto take = [&](int s) -> const PhdSight* {
        if (s < 0 || work.scan.sights[static_cast<std::size_t>(s)].view != view) return nullptr;
        if (std::exchange(work.shares[static_cast<std::size_t>(s)].numbered, true)) return nullptr;
        return &work.scan.sights[static_cast<std::size_t>(s)];
    };
    for (int k = group.first; k < group.last; ++k)
        if (const PhdSight* own = take(work.member(k).sight)) return own;
    const int component = work.member(group.first).component;
    for (const PhdTerm& term : work.terms)
        if (term.component == component)
            if (const PhdSight* other = take(term.sight)) return other;
    return nullptr;
}

/// As paper 4 prints it: a landmark goes through the filter once more with the detection that it has just
/// taken in.
void correctAgain(const PhdMap::Settings& settings, const Vector3& pose, const PhdTerm& heaviest,
                  const PhdScan& scan, PhdFeature& feature) {
    if (heaviest.sight < 0 || !PhdMap::isConfirmed(settings, feature)) return;
    const PhdSight& sight = scan.sights[static_cast<std::size_t>(heaviest.sight)];
    const SensorPlace place = placeOf(pose, scan.viewOf(sight).sensor);
    const PointSight expected = sightOf(feature.point, place, settings.transform);
    update(feature.point, expected, PointInnovation(expected, sight.z, sight.R));
}

}  // namespace

/// A group goes on in the place, and under the number, of its heaviest member whose place is still free.
/// Splits that find none take the number of a detection of theirs that starts nothing else: they too are what
/// it may have been of, or missed by. Where none is left either they join what has their heaviest member's
/// place.
void PhdMap::write(const Settings& settings, const Vector3& pose, int view, Work& work) {
    for (const PhdGroup& group : work.merged.groups) {
        const PhdTerm& heaviest = work.member(group.first);
        if (const Seen* holder = holderOf(group, work)) {
            const bool alone = group.last == group.first + 1 && heaviest.sight < 0;
            if (alone && group.weight == holder->from.weight)
                continue;  // nothing has changed: the page is not copied
            PhdFeature& feature = features_.write(holder->from.place);
            feature.weight = group.weight;
            if (alone) continue;
            feature.point = group.point;
            if (group.detected > 0.5 * group.weight) {
                ++feature.seen;
                feature.last_seen = work.scan.now;
            }
            if (settings.parameters.correction == PhdCorrection::twice)
                correctAgain(settings, pose, heaviest, work.scan, feature);
            features_.moved(holder->from.place);
        } else if (const PhdSight* sight = numberFor(group, view, work)) {
            PhdFeature feature;
            feature.id = sight->birth;
            feature.weight = group.weight;
            feature.point = group.point;
            feature.first_seen = feature.last_seen = work.scan.now;
            work.fresh.push_back(feature);
        } else {
            const Place place = work.seenOf(heaviest).from.place;
            PhdFeature& feature = features_.write(place);
            FeatureMixture both;
            both.add(feature.weight, feature.point);
            both.add(group.weight, group.point);
            feature.weight += group.weight;
            feature.point = both.moments();
            features_.moved(place);
        }
    }
    work.lost.clear();
    for (const Seen& seen : work.seen)
        if (!seen.kept) work.lost.push_back(seen.from.place);
    features_.remove(work.lost);
}

}  // namespace slamot
