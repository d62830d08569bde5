#pragma once
#include <CLI/CLI.hpp>

#include "slamot/study/Session.h"

namespace slamot::app {

/// What every program that runs studies takes on its command line: `slamot study` and `slamot_study_mpi`.
void addSessionOptions(CLI::App& app, study::SessionRequest& request);

/// An unset variable of a script gives an empty text, which is no name of a file.
CLI::Validator notEmpty();

}  // namespace slamot::app
