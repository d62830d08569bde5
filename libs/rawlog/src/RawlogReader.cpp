#include "slamot/rawlog/RawlogReader.h"

#include <fmt/format.h>
#include <mrpt/obs/CObservationComment.h>
#include <mrpt/obs/CObservationOdometry.h>

#include <algorithm>
#include <deque>

#include "ActionFrames.h"
#include "ObjectReader.h"
#include "ReorderQueue.h"
#include "slamot/rawlog/Conventions.h"
#include "slamot/rawlog/LogError.h"

namespace slamot {

ParameterTable describe(LogParameters& parameters) {
    ParameterTable table("log", "How a log is read.");
    table
        .real("reorder_window", parameters.reorder_window, "s", Interval::between(0, 3600),
              "Entries that arrive up to this late are put in order; later ones are dropped.")
        .real("step", parameters.step, "s", Interval{0, 3600, true, false},
              "Time of one frame in action-frame logs without usable stamps.");
    return table;
}

struct RawlogReader::Impl {
    Impl(const std::string& file_name, const LogParameters& log_parameters)
        : file(file_name), parameters(log_parameters), objects(file), queue(log_parameters.reorder_window, drops) {
        // The first object that is part of a log tells the format.
        while ((held = objects.next()) && !isAction(*held) && !isFrame(*held) && !isObservation(*held))
            dropOther(*held);
        if (held && !isObservation(*held)) {
            format = LogFormat::action_frames;
            timed_by_step = !frameStampsUsable(file);
        }
    }

    static bool isAction(const LogObject& o) { return IS_CLASS(*o.object, mrpt::obs::CActionCollection); }
    static bool isFrame(const LogObject& o) { return IS_CLASS(*o.object, mrpt::obs::CSensoryFrame); }
    static bool isObservation(const LogObject& o) {
        return IS_DERIVED(*o.object, mrpt::obs::CObservation) &&
               !IS_CLASS(*o.object, mrpt::obs::CObservationComment);
    }

    std::optional<LogObject> nextObject() {
        if (auto object = std::move(held)) {
            held.reset();
            return object;
        }
        return objects.next();
    }

    void dropOther(const LogObject& o) {
        const bool comment = IS_CLASS(*o.object, mrpt::obs::CObservationComment);
        drops.add(comment ? "" : o.object->GetRuntimeClass()->className,
                  comment ? "comment" : "not-an-observation");
    }

    std::optional<LogEntry> nextObservation() {
        while (true) {
            if (auto entry = queue.pop(at_end)) return entry;
            if (at_end) return std::nullopt;
            const auto object = nextObject();
            if (!object)
                at_end = true;
            else if (isObservation(*object))
                queue.push(std::dynamic_pointer_cast<mrpt::obs::CObservation>(object->object), object->position);
            else if (isAction(*object) || isFrame(*object))
                drops.add("", "frame-among-observations");
            else
                dropOther(*object);
        }
    }

    std::optional<LogEntry> nextOfFrames() {
        while (ready.empty() && !at_end) {
            const auto object = nextObject();
            std::optional<ActionFrame> frame;
            if (!object) {
                at_end = true;
                frame = pairer.flush();
            } else if (isAction(*object) || isFrame(*object)) {
                frame = pairer.add(*object);
            } else if (isObservation(*object)) {
                drops.add(std::dynamic_pointer_cast<mrpt::obs::CObservation>(object->object)->sensorLabel,
                          "outside-frame");
            } else {
                dropOther(*object);
            }
            if (frame) unpack(*frame);
        }
        if (ready.empty()) return std::nullopt;
        LogEntry entry = std::move(ready.front());
        ready.pop_front();
        return entry;
    }

    /// When the frame's movement ended and its observations were made. The log's start is step 0: a sensory
    /// frame before the first action lies there, the first action ends at step 1.
    Stamp timeOf(const ActionFrame& frame) {
        if (previous || frame.action) ++step;
        if (timed_by_step) return later(action_frame_epoch, static_cast<double>(step) * parameters.step);
        if (const auto stamp = frame.stamp(); stamp && (!previous || *stamp > *previous)) return *stamp;
        return later(previous.value_or(action_frame_epoch), parameters.step);
    }

    void unpack(const ActionFrame& frame) {
        const Stamp stamp = timeOf(frame);
        if (frame.action) {
            if (const auto movement = movementOf(*frame.action)) {
                OdometryIncrement increment = incrementOf(*movement, frame.position);
                increment.t0 = previous.value_or(later(stamp, -parameters.step));
                increment.t1 = stamp;
                increment.entry_seconds = increment.seconds();
                ready.push_back({stamp, nullptr, increment, frame.position});
            } else if (frame.action->size() > 0) {
                drops.add("", "not-planar-odometry");
            }
        }
        if (frame.observations) unpackObservations(*frame.observations, stamp, frame.position);
        previous = stamp;
    }

    static mrpt::obs::CActionRobotMovement2D::Ptr movementOf(const mrpt::obs::CActionCollection& action) {
        if (const auto best = action.getBestMovementEstimation()) return best;
        // MRPT passes over a movement whose uncertainty is no number.
        return action.getActionByClass<mrpt::obs::CActionRobotMovement2D>();
    }

    OdometryIncrement incrementOf(const mrpt::obs::CActionRobotMovement2D& movement,
                                  std::int64_t position) const {
        try {
            return fromMrpt(movement);
        } catch (const LogError& error) {
            throw LogError(fmt::format("{}: object {}: {}", file, position, error.what()));
        }
    }

    void unpackObservations(const mrpt::obs::CSensoryFrame& observations, Stamp stamp,
                            std::int64_t position) {
        std::vector<mrpt::obs::CObservation::Ptr> sorted;
        for (const auto& observation : observations) {
            if (!observation)
                drops.add("", "empty-object");
            else if (IS_CLASS(*observation, mrpt::obs::CObservationOdometry))
                drops.add(observation->sensorLabel, "odometry-within-frame");
            else
                sorted.push_back(observation);
        }
        std::stable_sort(sorted.begin(), sorted.end(), [](const auto& a, const auto& b) {
            return std::make_pair(orderRank(*a), a->sensorLabel) <
                   std::make_pair(orderRank(*b), b->sensorLabel);
        });
        for (const auto& observation : sorted) {
            observation->timestamp = toMrpt(stamp);
            ready.push_back({stamp, observation, std::nullopt, position});
        }
    }

    std::string file;
    LogParameters parameters;
    ObjectReader objects;
    std::optional<LogObject> held;
    DropTable drops;
    LogFormat format = LogFormat::observations;
    bool at_end = false, timed_by_step = false;

    ObservationQueue queue;  // observation logs

    FramePairer pairer;  // action-frame logs
    std::deque<LogEntry> ready;
    std::optional<Stamp> previous;
    std::int64_t step = 0;
};

RawlogReader::RawlogReader(const std::string& file, const LogParameters& parameters)
    : impl_(std::make_unique<Impl>(file, parameters)) {}
RawlogReader::~RawlogReader() = default;

std::optional<LogEntry> RawlogReader::next() {
    return impl_->format == LogFormat::observations ? impl_->nextObservation() : impl_->nextOfFrames();
}

LogFormat RawlogReader::format() const {
    return impl_->format;
}

bool RawlogReader::timedByStep() const {
    return impl_->timed_by_step;
}

LogEnd RawlogReader::end() const {
    return impl_->objects.end();
}

const std::string& RawlogReader::endMessage() const {
    return impl_->objects.endMessage();
}

std::int64_t RawlogReader::objects() const {
    return impl_->objects.objects();
}

const DropTable& RawlogReader::drops() const {
    return impl_->drops;
}

double RawlogReader::progress() const {
    return impl_->objects.progress();
}

}  // namespace slamot
