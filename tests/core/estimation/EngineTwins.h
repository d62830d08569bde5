#pragma once
// Filters over movers' modes whose engines make the same commits: a compressed bank that writes down what it
// puts away and brings back, and a dense bank that does the same at the same moments.
#include <algorithm>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "slamot/core/estimation/BankedImm.h"
#include "slamot/core/estimation/CompressedJointBank.h"
#include "slamot/core/estimation/DenseJointBank.h"
#include "slamot/core/filter/JointFilter.h"

namespace slamot::test {

struct CommitLog {
    struct Move {
        bool away;
        std::vector<BlockId> landmarks;
    };
    /// Of the compressed bank, in the order they came.
    std::vector<BlockId> blocks{robot_block};
    /// Of the present step.
    std::vector<Move> moves;
    /// Commits of several modes: those that are not exact.
    int merging_commits = 0;
};

class LoggedBank : public CompressedJointBank {
  public:
    LoggedBank(CommitLog& log, const PoseGaussian& robot, Consistency consistency,
               const ActiveSetParameters& parameters)
        : CompressedJointBank(robot.mean.vector(), robot.covariance, consistency, 1, parameters), log_(log) {}

    BlockId augment(BlockKind kind, const std::vector<NewBlock>& by_mode) override {
        log_.blocks.push_back(CompressedJointBank::augment(kind, by_mode));
        return log_.blocks.back();
    }
    void activate(const std::vector<BlockId>& landmarks) override {
        log_.moves.push_back({false, landmarks});
        CompressedJointBank::activate(landmarks);
    }
    void commit(const std::vector<BlockId>& landmarks, const ModeWeights& weights) override {
        log_.moves.push_back({true, landmarks});
        if (modeCount() > 1) ++log_.merging_commits;
        CompressedJointBank::commit(landmarks, weights);
    }

  private:
    CommitLog& log_;
};

/// Weights of commits are its own.
class FollowingBank : public DenseJointBank {
  public:
    FollowingBank(const CommitLog& log, const PoseGaussian& robot, Consistency consistency)
        : DenseJointBank(robot.mean.vector(), robot.covariance, consistency), log_(log) {}

    BlockId augment(BlockKind kind, const std::vector<NewBlock>& by_mode) override {
        blocks_.push_back(DenseJointBank::augment(kind, by_mode));
        return blocks_.back();
    }
    void attend(const Attention&, const ModeWeights& weights) override {
        for (const CommitLog::Move& move : log_.moves) {
            std::vector<BlockId> landmarks;
            for (const BlockId id : move.landmarks) {
                const auto place = std::find(log_.blocks.begin(), log_.blocks.end(), id);
                landmarks.push_back(blocks_.at(static_cast<std::size_t>(place - log_.blocks.begin())));
            }
            move.away ? commit(landmarks, weights) : activate(landmarks);
        }
    }

  private:
    const CommitLog& log_;
    std::vector<BlockId> blocks_{robot_block};
};

/// JointFilter's handling of objects around a given bank, in one form for the whole run: tracks end after 2
/// s.
class ModalRun {
  public:
    ModalRun(const JointFilterParameters& p, std::unique_ptr<JointBank> bank) : models_(modelsOf(p.imm)) {
        const auto settings = settingsFrom(p, RobotMotionParameters{});
        auto exact = std::make_unique<JointImm>(settings, std::move(bank));
        if (p.imm.form == ImmForm::scalable)
            belief_ = std::make_unique<BankedImm>(settings, std::move(*exact));
        else
            belief_ = std::move(exact);
    }

    void step(const OdometryIncrement& odometry, const DetectionSet& set) {
        belief_->predict(odometry, models_);
        for (auto track = tracks_.begin(); track != tracks_.end();) {
            if (secondsBetween(track->second.seen, odometry.t1) > 2) {
                belief_->removeTarget(track->second.block);
                track = tracks_.erase(track);
            } else {
                ++track;
            }
        }
        update(set);
    }

    const ModalState& belief() const { return *belief_; }
    /// Robot, movers, landmarks, each by the log's identity.
    std::vector<BlockId> blocks() const {
        std::vector<BlockId> out{robot_block};
        for (const BlockId id : targets()) out.push_back(id);
        for (const BlockId id : landmarks()) out.push_back(id);
        return out;
    }
    std::vector<BlockId> targets() const {
        std::vector<BlockId> out;
        for (const auto& [source, track] : tracks_) out.push_back(track.block);
        return out;
    }
    std::vector<BlockId> landmarks() const {
        std::vector<BlockId> out;
        for (const auto& [source, block] : landmarks_) out.push_back(block);
        return out;
    }

  private:
    struct Track {
        BlockId block;
        Stamp seen;
    };

    void update(const DetectionSet& set) {
        const RangeBearingSet& seen = set.rangeBearing();
        KnownObjects known;
        std::vector<Innovation> innovations(seen.detections.size());
        std::vector<const RangeBearingDetection*> first_sights;
        for (std::size_t i = 0; i < seen.detections.size(); ++i) {
            const RangeBearingDetection& detection = seen.detections[i];
            const int index = static_cast<int>(i);
            innovations[i].detection = index;
            const auto track = tracks_.find(detection.source.value);
            const auto landmark = landmarks_.find(detection.source.value);
            if (detection.kind == ObjectKind::mover && track != tracks_.end()) {
                known.targets.push_back({index, track->second.block});
                track->second.seen = set.stamp;
            } else if (detection.kind == ObjectKind::landmark && landmark != landmarks_.end()) {
                known.landmarks.push_back({index, landmark->second});
            } else {
                first_sights.push_back(&detection);
            }
        }
        std::vector<BlockId> measured;
        for (const auto* sights : {&known.landmarks, &known.targets})
            for (const auto& sight : *sights) measured.push_back(sight.block);
        belief_->attend(seen, measured);
        belief_->update(seen, known, innovations);
        for (const RangeBearingDetection* detection : first_sights) {
            const Pose2& sensor = seen.sensors[static_cast<std::size_t>(detection->sensor)].pose;
            const RelativeGaussian point =
                firstSight(*detection, sensor, belief_->bank().consistency());
            if (detection->kind == ObjectKind::mover)
                tracks_[detection->source.value] = {belief_->addTarget(moverAt(point, 3.0, 2.0)), set.stamp};
            else
                landmarks_[detection->source.value] = belief_->addLandmark(point);
        }
    }

    std::vector<TargetModel> models_;
    std::unique_ptr<ModalState> belief_;
    std::map<std::int64_t, Track> tracks_;
    std::map<std::int64_t, BlockId> landmarks_;
};

}  // namespace slamot::test
