#include "slamot/core/filter/ModalBelief.h"

#include "slamot/core/estimation/BankedImm.h"
#include "slamot/core/estimation/DecoupledImm.h"

namespace slamot {

void ModalBelief::start(std::unique_ptr<JointBank> bank) {
    targets_ = 0;
    if (form_ == ImmForm::decoupled)
        state_ = std::make_unique<DecoupledImm>(settings_, std::move(bank));
    else
        state_ = std::make_unique<JointImm>(settings_, std::move(bank));
    if (form_ == ImmForm::scalable) becomeScalable();
}

std::optional<BlockId> ModalBelief::addTarget(const RelativeGaussian& target) {
    if (!hasRoom()) return std::nullopt;
    if (!fitsExact() && form_ == ImmForm::automatic) becomeScalable();
    ++targets_;
    return state_->addTarget(target);
}

void ModalBelief::removeTarget(BlockId target) {
    state_->removeTarget(target);
    if (--targets_ == 0 && form_ == ImmForm::automatic) becomeExact();
}

void ModalBelief::becomeScalable() {
    if (auto* exact = dynamic_cast<JointImm*>(state_.get()))
        state_ = std::make_unique<BankedImm>(settings_, std::move(*exact));
}

void ModalBelief::becomeExact() {
    if (auto* scalable = dynamic_cast<BankedImm*>(state_.get()))
        state_ = std::make_unique<JointImm>(settings_, scalable->release());
}

}  // namespace slamot
