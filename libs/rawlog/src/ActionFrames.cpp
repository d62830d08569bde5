#include "ActionFrames.h"

#include <algorithm>

#include "slamot/rawlog/Conventions.h"

namespace slamot {

std::optional<Stamp> usableStamp(mrpt::Clock::time_point time) {
    constexpr std::int64_t latest = std::int64_t{1} << 62;  // leaves room for adding durations
    const std::int64_t ticks = time.time_since_epoch().count();
    if (ticks <= 0 || ticks > latest) return std::nullopt;
    return toStamp(time);
}

std::optional<Stamp> ActionFrame::stamp() const {
    if (observations)
        for (const auto& observation : *observations)
            if (const auto stamp = observation ? usableStamp(observation->timestamp) : std::nullopt) return stamp;
    if (action)
        for (const auto& movement : *action)
            if (const auto stamp = usableStamp(movement->timestamp)) return stamp;
    return std::nullopt;
}

std::optional<ActionFrame> FramePairer::add(const LogObject& object) {
    if (auto action = std::dynamic_pointer_cast<mrpt::obs::CActionCollection>(object.object)) {
        auto complete = flush();
        pending_ = ActionFrame{action, nullptr, object.position};
        return complete;
    }
    ActionFrame frame = pending_.value_or(ActionFrame{nullptr, nullptr, object.position});
    pending_.reset();
    frame.observations = std::dynamic_pointer_cast<mrpt::obs::CSensoryFrame>(object.object);
    return frame;
}

std::optional<ActionFrame> FramePairer::flush() {
    auto frame = pending_;
    pending_.reset();
    return frame;
}

bool frameStampsUsable(const std::string& file) {
    constexpr double least_seconds_per_frame = 1e-3;
    ObjectReader objects(file);
    FramePairer pairer;
    std::optional<Stamp> first, last;
    std::int64_t frames = 0;
    bool usable = true;
    const auto look = [&](const std::optional<ActionFrame>& frame) {
        if (!frame) return;
        const auto stamp = frame->stamp();
        if (!stamp || (last && *stamp <= *last)) {
            usable = false;
            return;
        }
        if (!first) first = stamp;
        last = stamp;
        ++frames;
    };
    while (usable) {
        const auto object = objects.next();
        if (!object) break;
        if (IS_CLASS(*object->object, mrpt::obs::CActionCollection) ||
            IS_CLASS(*object->object, mrpt::obs::CSensoryFrame))
            look(pairer.add(*object));
    }
    // An action after the last sensory frame seldom has a stamp: it does not count against the log.
    return usable && frames > 0 &&
           secondsBetween(*first, *last) >= least_seconds_per_frame * static_cast<double>(frames - 1);
}

}  // namespace slamot
