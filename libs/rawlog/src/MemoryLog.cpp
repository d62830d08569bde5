#include "slamot/rawlog/MemoryLog.h"

#include "ReorderQueue.h"

namespace slamot {

struct MemoryLog::Impl {
    Impl(std::shared_ptr<const std::vector<mrpt::obs::CObservation::Ptr>> all, double window)
        : observations(std::move(all)), queue(window, drops) {}

    std::shared_ptr<const std::vector<mrpt::obs::CObservation::Ptr>> observations;
    DropTable drops;
    ObservationQueue queue;
    std::size_t taken = 0;
    const std::string no_message;
};

MemoryLog::MemoryLog(std::shared_ptr<const std::vector<mrpt::obs::CObservation::Ptr>> observations,
                     const LogParameters& parameters)
    : impl_(std::make_unique<Impl>(std::move(observations), parameters.reorder_window)) {}
MemoryLog::~MemoryLog() = default;

std::optional<LogEntry> MemoryLog::next() {
    const auto& all = *impl_->observations;
    while (true) {
        const bool at_end = impl_->taken == all.size();
        if (auto entry = impl_->queue.pop(at_end)) return entry;
        if (at_end) return std::nullopt;
        impl_->queue.push(all[impl_->taken], static_cast<std::int64_t>(impl_->taken));
        ++impl_->taken;
    }
}

LogEnd MemoryLog::end() const {
    return impl_->taken == impl_->observations->size() ? LogEnd::clean : LogEnd::not_yet;
}

const std::string& MemoryLog::endMessage() const {
    return impl_->no_message;
}

const DropTable& MemoryLog::drops() const {
    return impl_->drops;
}

double MemoryLog::progress() const {
    return impl_->observations->empty()
               ? 1.0
               : static_cast<double>(impl_->taken) / static_cast<double>(impl_->observations->size());
}

}  // namespace slamot
