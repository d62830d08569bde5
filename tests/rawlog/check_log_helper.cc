// Stands in for the application in the tests of summariseInChild: `check_log_helper check-log FILE
// --memory-limit BYTES --reorder-window S --step S`. The file names `die`, `interrupted` and `too_long` make
// it die of a signal; `tell` makes it answer with its limits and what it inherited.
#include <sys/resource.h>

#include <csignal>
#include <cstdlib>
#include <iostream>
#include <string>

#include "slamot/rawlog/LogCheck.h"

int main(int argc, char** argv) {
    if (argc != 9 || std::string(argv[1]) != "check-log") return 64;
    const std::string file = argv[2];
    if (file == "die") std::raise(SIGKILL);
    if (file == "interrupted") std::raise(SIGINT);
    if (file == "too_long") std::raise(SIGXCPU);  // as the kernel does at the limit
    slamot::LogParameters parameters;
    parameters.reorder_window = std::stod(argv[6]);
    parameters.step = std::stod(argv[8]);
    const int exit_code = slamot::checkLogMain(file, parameters, std::stoull(argv[4]));
    if (file == "tell") {
        rlimit cpu{};
        getrlimit(RLIMIT_CPU, &cpu);
        const char* threads = std::getenv("OPENBLAS_NUM_THREADS");
        std::cout << R"({"error": "cpu )" << cpu.rlim_cur << ", threads " << (threads ? threads : "?")
                  << ", SIGINT " << (std::signal(SIGINT, SIG_DFL) == SIG_DFL ? "default" : "other")
                  << "\"}\n";
    }
    return exit_code;
}
