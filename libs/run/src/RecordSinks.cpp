#include "slamot/run/RecordSinks.h"

#include <openssl/evp.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace slamot::run {

void RunRecorder::step(const Step& step) {
    for (const Innovation& innovation : step.report.innovations) {
        const RangeBearingSet& set = step.detections.rangeBearing();
        record_.innovations.push_back(
            {step.estimate.stamp, set.sensors[set.detections[innovation.detection].sensor].label, innovation});
    }
    if (!clock_.due(step)) return;
    record_.trajectory.push_back({step.estimate.stamp, step.estimate.robot});
    if (!step.estimate.tracks.empty()) record_.tracks[step.estimate.stamp] = step.estimate.tracks;
}

struct EstimateHash::Impl {
    EVP_MD_CTX* context = EVP_MD_CTX_new();
    ~Impl() { EVP_MD_CTX_free(context); }
    template <class T>
    void add(const T* data, std::size_t count) {
        EVP_DigestUpdate(context, data, count * sizeof(T));
    }
    void add(std::int64_t value) { add(&value, 1); }
};

EstimateHash::EstimateHash() : impl_(std::make_unique<Impl>()) {
    EVP_DigestInit_ex(impl_->context, EVP_sha256(), nullptr);
}

EstimateHash::~EstimateHash() = default;

void EstimateHash::step(const Step& step) {
    impl_->add(step.estimate.stamp.ticks);
    impl_->add(step.estimate.robot.mean.vector().data(), 3);
    impl_->add(step.estimate.robot.covariance.data(), 9);
    for (const TrackEstimate& track : step.estimate.tracks) {
        impl_->add(track.id.value);
        impl_->add(track.mean.data(), 6);
        impl_->add(track.covariance.data(), 36);
        impl_->add(&track.existence, 1);
        impl_->add(track.mode_probabilities.data(), track.mode_probabilities.size());
    }
}

void EstimateHash::end(const RunEnd& end) {
    for (const LandmarkEstimate& landmark : end.landmarks) {
        impl_->add(landmark.id.value);
        impl_->add(landmark.mean.data(), 2);
        impl_->add(landmark.covariance.data(), 4);
    }
    unsigned char digest[EVP_MAX_MD_SIZE];
    unsigned size = 0;
    EVP_DigestFinal_ex(impl_->context, digest, &size);
    for (unsigned i = 0; i < size; ++i) {
        constexpr const char* digits = "0123456789abcdef";
        hex_ += digits[digest[i] >> 4];
        hex_ += digits[digest[i] & 15];
    }
}

void StepTimer::step(const Step& step) {
    pending_ += step.times.predict + step.times.detect + step.times.update;
    if (!step.has_detections) return;
    seconds_.push_back(pending_);
    pending_ = 0;
}

double StepTimer::percentile(double q) const {
    if (seconds_.empty()) return std::numeric_limits<double>::quiet_NaN();
    std::vector<double> sorted = seconds_;
    const auto index = static_cast<std::ptrdiff_t>(std::ceil(q * static_cast<double>(sorted.size())) - 1);
    const auto at = sorted.begin() + std::max<std::ptrdiff_t>(index, 0);
    std::nth_element(sorted.begin(), at, sorted.end());
    return *at;
}

}  // namespace slamot::run
