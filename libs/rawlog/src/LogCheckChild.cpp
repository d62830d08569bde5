#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <iostream>
#include <nlohmann/json.hpp>

#include "slamot/core/config/Parameters.h"
#include "slamot/rawlog/LogCheck.h"
#include "slamot/rawlog/LogError.h"

extern char** environ;

namespace slamot {
namespace {

// Sanitizers reserve terabytes of address space.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool memory_can_be_limited = false;
#else
constexpr bool memory_can_be_limited = true;
#endif

constexpr int exit_unusable = 2;

void lower(int resource, rlim_t limit) {
    rlimit limits{};
    getrlimit(static_cast<__rlimit_resource_t>(resource), &limits);
    limits.rlim_cur = std::min(limit, limits.rlim_max);
    setrlimit(static_cast<__rlimit_resource_t>(resource), &limits);
}

/// This process's environment, with OpenBLAS kept to one thread: the stacks of a pool with a thread per core
/// would eat the limited address space.
std::vector<std::string> childEnvironment() {
    const std::string name = "OPENBLAS_NUM_THREADS=";
    std::vector<std::string> variables = {name + "1"};
    for (char** variable = environ; *variable; ++variable)
        if (std::strncmp(*variable, name.c_str(), name.size()) != 0) variables.emplace_back(*variable);
    return variables;
}

std::vector<char*> nullTerminated(std::vector<std::string>& texts) {
    std::vector<char*> pointers;
    for (auto& text : texts) pointers.push_back(text.data());
    pointers.push_back(nullptr);
    return pointers;
}

/// A finished child: how it ended and what it printed.
struct Child {
    int status = 0;
    std::string output;
};

Child runChild(std::vector<std::string> arguments) {
    std::array<int, 2> ends{};
    if (pipe2(ends.data(), O_CLOEXEC) != 0)
        throw std::runtime_error(fmt::format("no pipe can be made ({})", std::strerror(errno)));
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
    // MRPT prints what it makes of broken objects; the answer comes through the pipe.
    posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
    // The user's Ctrl-C ends the child even where the parent ignores or blocks it.
    posix_spawnattr_t attributes;
    posix_spawnattr_init(&attributes);
    sigset_t interrupt, none;
    sigemptyset(&none);
    sigemptyset(&interrupt);
    sigaddset(&interrupt, SIGINT);
    posix_spawnattr_setsigdefault(&attributes, &interrupt);
    posix_spawnattr_setsigmask(&attributes, &none);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETSIGMASK);
    std::vector<std::string> environment = childEnvironment();
    const std::vector<char*> argv = nullTerminated(arguments), envp = nullTerminated(environment);

    pid_t pid = 0;
    const int error = posix_spawn(&pid, argv[0], &actions, &attributes, argv.data(), envp.data());
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&actions);
    close(ends[1]);
    Child child;
    if (error == 0) {
        std::array<char, 4096> buffer{};
        ssize_t got = 0;
        while ((got = read(ends[0], buffer.data(), buffer.size())) > 0 || (got < 0 && errno == EINTR))
            if (got > 0) child.output.append(buffer.data(), static_cast<std::size_t>(got));
        while (waitpid(pid, &child.status, 0) < 0 && errno == EINTR) {
        }
    }
    close(ends[0]);
    if (error != 0)
        throw std::runtime_error(
            fmt::format("{} cannot be started to check a log ({})", arguments[0], std::strerror(error)));
    return child;
}

/// The answer is the last line: MRPT may have printed before.
std::string lastLine(std::string text) {
    while (!text.empty() && text.back() == '\n') text.pop_back();
    return text.substr(text.rfind('\n') + 1);
}

bool diedOf(const Child& child, int signal) {
    return WIFSIGNALED(child.status) && WTERMSIG(child.status) == signal;
}

std::string causeOfDeath(const Child& child) {
    if (WIFSIGNALED(child.status))
        return fmt::format("died of signal {} ({})", WTERMSIG(child.status),
                           strsignal(WTERMSIG(child.status)));
    return fmt::format("ended with exit code {} and no answer", WEXITSTATUS(child.status));
}

}  // namespace

int checkLogMain(const std::string& file, const LogParameters& parameters, std::uint64_t memory_limit) {
    lower(RLIMIT_CORE, 0);
    lower(RLIMIT_CPU, log_check_cpu_limit);
    if (memory_can_be_limited) lower(RLIMIT_AS, memory_limit);
    try {
        std::cout << toJson(summarise(file, parameters)) << std::endl;
        return 0;
    } catch (const LogError& error) {
        const nlohmann::json answer = {{"error", error.what()}};
        std::cout << answer.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) << std::endl;
        return exit_unusable;
    }
}

LogSummary summariseInChild(const std::string& program, const std::string& file,
                            const LogParameters& parameters, std::uint64_t memory_limit) {
    const Child child = runChild({program, "check-log", file, "--memory-limit", std::to_string(memory_limit),
                                  "--reorder-window", shortestText(parameters.reorder_window), "--step",
                                  shortestText(parameters.step)});
    const std::string answer = lastLine(child.output);
    const bool exited = WIFEXITED(child.status);
    if (exited && WEXITSTATUS(child.status) == 0) return logSummaryFromJson(answer);
    if (exited && WEXITSTATUS(child.status) == exit_unusable) {
        const auto json = nlohmann::json::parse(answer, nullptr, false);
        if (json.is_object() && json.contains("error")) throw LogError(json.value("error", ""));
    }
    if (diedOf(child, SIGINT))
        throw std::runtime_error(fmt::format("{}: looking through the log was interrupted", file));
    LogSummary summary;
    summary.end = LogEnd::corrupt;
    summary.end_message =
        diedOf(child, SIGXCPU)
            ? fmt::format(
                  "{}: the process reading the log was not done within {} s of CPU time, so the log "
                  "counts as damaged",
                  file, log_check_cpu_limit)
            : fmt::format("{}: the log is so damaged that the process reading it {}", file,
                          causeOfDeath(child));
    return summary;
}

}  // namespace slamot
