#pragma once
#include <EkfSlamot.h>

namespace slamot {

/// ekf_slamot with a sign error put in on purpose: it turns against the steering. The studies must find it.
class SignError : public EkfSlamot {
    DEFINE_MRPT_OBJECT(SignError, slamot)

  public:
    std::string name() const override { return "sign_error"; }

  protected:
    void onPredict(const OdometryIncrement& odometry) override;
};

}  // namespace slamot
