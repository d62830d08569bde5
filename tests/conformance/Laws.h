#pragma once
// What every estimator owes its users, as functions: each returns an empty text when its law holds, else one
// sentence on what broke it. Exceptions that a law does not ask for break it.
#include <string>

#include "conformance/Subject.h"

namespace slamot::conformance {

using Verdict = std::string;

/// Equal start, equal input: equal bits from new objects with 1, 2 and 4 threads.
Verdict sameBitsForAnyThreads(const Options& options);
/// `reset` after a run equals a new object, bit for bit; so does a start after a different run.
Verdict resetEqualsNew(const Options& options);
/// Robot, tracks and the whole joint covariance are symmetric and positive semi-definite after every call.
Verdict covariancesStayDefinite(const Options& options);
/// Looking and seeing nothing is legal; a deterministic estimator stays where it is.
Verdict emptySetIsAccepted(const Options& options);
/// Time going back is a TimeOrderError, changes nothing, and the run can go on.
Verdict timeGoingBackIsRefused(const Options& options);
/// What the cheap and the expensive queries say fits together.
Verdict queriesAgree(const Options& options);

/// Printing, parsing and loading give back what was there; nonsense is refused; sections carry the plugin's
/// name.
Verdict parametersRoundTrip(const Options& options);
/// A misspelt key is a ConfigError that names it.
Verdict unknownKeyIsRefused(const Options& options);

/// A turned and shifted start gives the turned and shifted answer.
Verdict worldMayBeMoved(const Options& options);
/// Bearings and headings on both sides of +-pi.
Verdict bearingsAcrossPi(const Options& options);
/// Without noise in the world the estimate ends at the truth.
Verdict noiseFreeConverges(const Options& options);
/// Fifty movers coming and going, doubles, nameless and absurd detections.
Verdict crowdIsSurvived(const Options& options);
/// Mean NEES of the robot over seeded runs lies in its chi-square band.
Verdict neesInBand(const Options& options);

}  // namespace slamot::conformance
