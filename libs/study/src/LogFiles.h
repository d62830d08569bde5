#pragma once
#include <string>
#include <vector>

#include "slamot/study/Plan.h"

namespace slamot::study {

struct FoundFolder {
    std::string folder;
    std::string why_none;  ///< a sentence, when it is not there
};

/// The folder of a source's dataset, by its name in SLAMOT_DATASETS.
FoundFolder findDataset(const StudyFile& study, const Source& source, const std::string& name);

struct FoundLogs {
    std::vector<std::string> files;
    std::string why_none;  ///< a sentence, when the dataset is not there
};

/// The logs of a `[log.NAME]` section, by name with numbers in their order. An import is made once in
/// `work_folder` and found there again by later and by simultaneous programs. Throws ConfigError or LogError.
FoundLogs findLogs(const StudyFile& study, const Source& source, const std::string& work_folder);

}  // namespace slamot::study
