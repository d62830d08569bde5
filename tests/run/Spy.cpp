#include "run/Spy.h"

IMPLEMENTS_MRPT_OBJECT(Spy, Estimator, slamot)
