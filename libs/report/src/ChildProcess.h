#pragma once
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace slamot::report {

struct ChildResult {
    bool started = false;  ///< false: there is no such program
    int exit_code = -1;    ///< -1: ended by a signal
    std::string errors;    ///< what it said on standard error
};

/// Runs a program found on PATH, without a shell, reading `input` and writing `output`, and waits for its
/// end. It gets this process' environment with `extra_paths` appended to the variables of those names, after
/// a colon. Throws ReportError if a file cannot be opened.
ChildResult runChild(const std::vector<std::string>& command, const std::filesystem::path& input,
                     const std::filesystem::path& output,
                     const std::map<std::string, std::string>& extra_paths = {});

}  // namespace slamot::report
