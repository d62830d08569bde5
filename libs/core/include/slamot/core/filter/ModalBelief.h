#pragma once
// Robot, movers and map with the movers' modes, kept in the form that fits the number of movers.
#include <memory>
#include <optional>

#include "slamot/core/estimation/ModalState.h"

namespace slamot {

class ModalBelief {
  public:
    ModalBelief(std::shared_ptr<const ModalSettings> settings, ImmForm form, int max_exact_targets)
        : settings_(std::move(settings)), form_(form), max_exact_targets_(max_exact_targets) {}

    /// `bank` has one mode and no movers.
    void start(std::unique_ptr<JointBank> bank);

    ModalState& operator*() { return *state_; }
    const ModalState& operator*() const { return *state_; }
    ModalState* operator->() { return state_.get(); }
    const ModalState* operator->() const { return state_.get(); }

    /// Whether another mover can be added: the exact form has only so many.
    bool hasRoom() const { return form_ != ImmForm::exact || fitsExact(); }
    /// None where there is no room.
    std::optional<BlockId> addTarget(const RelativeGaussian& target);
    void removeTarget(BlockId target);

  private:
    bool fitsExact() const { return settings_->chain.modes() == 1 || targets_ < max_exact_targets_; }
    void becomeScalable();
    void becomeExact();

    std::shared_ptr<const ModalSettings> settings_;
    ImmForm form_;
    int max_exact_targets_;
    std::unique_ptr<ModalState> state_;
    int targets_ = 0;
};

}  // namespace slamot
