#pragma once
#include "slamot/report/ReportSection.h"

namespace slamot::report {

extern const ReportSection summary_section, map_section, replay_section, robot_error_section,
    track_error_section, nees_section, nis_section, mode_section, landmark_error_section, correlation_section,
    particle_section, count_section, outcome_section, time_section, drop_section, configuration_section;

}  // namespace slamot::report
