// Stands in for the application in the tests of summariseInChild: `check_log_helper check-log FILE
// --memory-limit BYTES --reorder-window S --step S`. The file name `die` makes it die of a signal.
#include <csignal>
#include <string>

#include "slamot/rawlog/LogCheck.h"

int main(int argc, char** argv) {
    if (argc != 9 || std::string(argv[1]) != "check-log") return 64;
    const std::string file = argv[2];
    if (file == "die") std::raise(SIGKILL);
    slamot::LogParameters parameters;
    parameters.reorder_window = std::stod(argv[6]);
    parameters.step = std::stod(argv[8]);
    return slamot::checkLogMain(file, parameters, std::stoull(argv[4]));
}
