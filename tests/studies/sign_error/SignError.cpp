#include "SignError.h"

IMPLEMENTS_MRPT_OBJECT(SignError, EkfSlamot, slamot)

namespace slamot {

void SignError::onPredict(const OdometryIncrement& odometry) {
    OdometryIncrement wrong = odometry;
    if (wrong.velocity) wrong.velocity->omega = -wrong.velocity->omega;
    if (wrong.velocity) wrong.velocity->vy = -wrong.velocity->vy;
    EkfSlamot::onPredict(wrong);
}

}  // namespace slamot
