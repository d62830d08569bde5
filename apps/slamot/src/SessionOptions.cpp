#include "SessionOptions.h"

namespace slamot::app {

CLI::Validator notEmpty() {
    return {[](const std::string& text) {
                return text.empty() ? std::string("expected something, not ''") : std::string();
            },
            ""};
}

void addSessionOptions(CLI::App& app, study::SessionRequest& request) {
    app.add_option("study", request.study_file, "Study INI file (doc/studies.md)")->required();
    // SQLite would keep the rows of a file without a name nowhere, and every node would run everything.
    app.add_option("--db", request.store_file, "SQLite file of the rows; what it has is not run again")
        ->check(notEmpty())
        ->required();
    app.add_option("--replicates", request.replicates, "Instead of [study] replicates")
        ->check(CLI::Range(1, 1000000));
    app.add_flag("--short", request.short_form, "As many replicates as [study] short_replicates");
    app.add_flag("--retry-failed", request.retry_failed, "Run failed rows again");
    app.add_flag("--any-build", request.any_build, "Keep rows that another build of the program made");
}

}  // namespace slamot::app
